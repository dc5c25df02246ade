#include "compare/image_filter.h"

#include "core/parallel_rows.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// sums[i] += weight * values[i]: weight by weight over a whole row, each sum keeps its order, and several are made at once.
void add_weighted(float* sums, const float* values, float weight, size_t count)
{
    for (size_t i = 0; i < count; ++i) sums[i] += weight * values[i];
}

std::vector<float> filter_rows(const std::vector<float>& source, int width, int height, std::span<const float> kernel)
{
    const int          radius = int(kernel.size() / 2);
    std::vector<float> result(source.size());
    parallel_rows(height, 0, [&](int y) {
        const float*       row = &source[size_t(y) * size_t(width)];
        std::vector<float> padded(size_t(width) + 2 * size_t(radius));
        for (int x = -radius; x < width + radius; ++x) padded[size_t(x + radius)] = row[std::clamp(x, 0, width - 1)];
        for (size_t k = 0; k < kernel.size(); ++k)
            add_weighted(&result[size_t(y) * size_t(width)], &padded[k], kernel[k], size_t(width));
    });
    return result;
}

std::vector<float> filter_columns(const std::vector<float>& source, int width, int height,
                                  std::span<const float> kernel)
{
    const int          radius = int(kernel.size() / 2);
    std::vector<float> result(source.size());
    parallel_rows(height, 0, [&](int y) {
        for (int k = 0; k < int(kernel.size()); ++k) {
            const int row = std::clamp(y + k - radius, 0, height - 1);
            add_weighted(&result[size_t(y) * size_t(width)], &source[size_t(row) * size_t(width)], kernel[size_t(k)],
                         size_t(width));
        }
    });
    return result;
}

} // namespace

Plane filter_separable(const Plane& plane, std::span<const float> kernel_x, std::span<const float> kernel_y)
{
    const glm::ivec2 size = plane.size_px;
    return {size, filter_columns(filter_rows(plane.values, size.x, size.y, kernel_x), size.x, size.y, kernel_y)};
}

// IEC 61966-2-1.
float srgb_to_linear(float value)
{
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

float linear_to_srgb(float value)
{
    if (!(value > 0)) return 0;
    if (value >= 1) return 1;
    return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
}

} // namespace ssrlab
