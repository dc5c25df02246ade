#include "compare/image_filter.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// Filters the columns of `source` into rows of the result, so that two calls filter both ways and restore the orientation.
std::vector<float> filter_rows_and_transpose(const std::vector<float>& source, int width, int height,
                                             std::span<const float> kernel)
{
    const int          radius = int(kernel.size() / 2);
    std::vector<float> result(source.size());
    std::vector<float> padded(size_t(width + 2 * radius));
    for (int y = 0; y < height; ++y) {
        const float* row = &source[size_t(y) * size_t(width)];
        for (int x = -radius; x < width + radius; ++x) padded[size_t(x + radius)] = row[std::clamp(x, 0, width - 1)];
        for (int x = 0; x < width; ++x) {
            float sum = 0;
            for (size_t k = 0; k < kernel.size(); ++k) sum += kernel[k] * padded[size_t(x) + k];
            result[size_t(x) * size_t(height) + size_t(y)] = sum;
        }
    }
    return result;
}

} // namespace

Plane filter_separable(const Plane& plane, std::span<const float> kernel_x, std::span<const float> kernel_y)
{
    const glm::ivec2 size = plane.size_px;
    return {size, filter_rows_and_transpose(filter_rows_and_transpose(plane.values, size.x, size.y, kernel_x), size.y,
                                            size.x, kernel_y)};
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
