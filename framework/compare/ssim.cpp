#include "compare/ssim.h"

#include "core/parallel_rows.h"

#include <cmath>
#include <utility>

namespace ssrlab {
namespace {

constexpr float c1 = 0.01F * 0.01F, c2 = 0.03F * 0.03F;

std::vector<float> gaussian_window()
{
    constexpr int      radius = 5;
    constexpr float    sigma  = 1.5F;
    std::vector<float> window;
    float              total = 0;
    for (int i = -radius; i <= radius; ++i) {
        window.push_back(std::exp(-float(i * i) / (2 * sigma * sigma)));
        total += window.back();
    }
    for (float& weight : window) weight /= total;
    return window;
}

Plane product(const Plane& a, const Plane& b)
{
    Plane result = a;
    parallel_pixels(a.size_px.x, a.size_px.y, [&](size_t i) { result.values[i] *= b.values[i]; });
    return result;
}

Plane mean_around(const Plane& plane)
{
    static const std::vector<float> window = gaussian_window();
    return filter_separable(plane, window, window);
}

} // namespace

SsimView ssim_view(Plane luma)
{
    SsimView view{std::move(luma), {}, {}};
    view.mean        = mean_around(view.luma);
    view.mean_square = mean_around(product(view.luma, view.luma));
    return view;
}

std::vector<float> ssim_map(const SsimView& a, const SsimView& b, const Mask& mask)
{
    const Plane        mean_ab = mean_around(product(a.luma, b.luma));
    std::vector<float> index(a.luma.values.size());
    parallel_pixels(a.luma.size_px.x, a.luma.size_px.y, [&](size_t i) {
        if (!is_inside(mask, i)) return;
        const float ma = a.mean.values[i], mb = b.mean.values[i];
        const float variances  = a.mean_square.values[i] - ma * ma + b.mean_square.values[i] - mb * mb;
        const float covariance = mean_ab.values[i] - ma * mb;
        index[i] = (2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (variances + c2));
    });
    return index;
}

} // namespace ssrlab
