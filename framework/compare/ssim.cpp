#include "compare/ssim.h"

#include "core/parallel_rows.h"

#include <cmath>

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

} // namespace

std::vector<float> ssim_map(const Plane& a, const Plane& b)
{
    const std::vector<float> window = gaussian_window();
    const auto               mean   = [&](const Plane& plane) { return filter_separable(plane, window, window); };
    const Plane              mean_a = mean(a), mean_b = mean(b);
    const Plane        mean_aa = mean(product(a, a)), mean_bb = mean(product(b, b)), mean_ab = mean(product(a, b));
    std::vector<float> index(a.values.size());
    parallel_pixels(a.size_px.x, a.size_px.y, [&](size_t i) {
        const float ma = mean_a.values[i], mb = mean_b.values[i];
        const float variances  = mean_aa.values[i] - ma * ma + mean_bb.values[i] - mb * mb;
        const float covariance = mean_ab.values[i] - ma * mb;
        index[i] = (2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (variances + c2));
    });
    return index;
}

} // namespace ssrlab
