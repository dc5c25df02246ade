#include "compare/image_filter.h"

#include "core/parallel_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

/// result[x] = sum over k of kernel[k] * rows[k][x]. Each sum keeps its order; a block of them stays in registers.
void weigh_rows(float* result, std::span<const float* const> rows, std::span<const float> kernel, size_t width)
{
    constexpr size_t block = 16;
    size_t           x     = 0;
    for (; x + block <= width; x += block) {
        std::array<float, block> sums{};
        for (size_t k = 0; k < kernel.size(); ++k) {
            const float* values = rows[k] + x;
            const float  weight = kernel[k];
            for (size_t i = 0; i < block; ++i) sums[i] += weight * values[i];
        }
        std::ranges::copy(sums, result + x);
    }
    for (; x < width; ++x) {
        float sum = 0;
        for (size_t k = 0; k < kernel.size(); ++k) sum += kernel[k] * rows[k][x];
        result[x] = sum;
    }
}

std::vector<float> filter_rows(const std::vector<float>& source, int width, int height, std::span<const float> kernel)
{
    const int          radius = int(kernel.size() / 2);
    std::vector<float> result(source.size());
    parallel_rows(height, threads_for(width, height), [&](int y) {
        const float*       row = &source[size_t(y) * size_t(width)];
        std::vector<float> padded(size_t(width) + 2 * size_t(radius));
        for (size_t i = 0; i < padded.size(); ++i) padded[i] = row[std::clamp(int(i) - radius, 0, width - 1)];
        std::vector<const float*> shifted;
        for (size_t k = 0; k < kernel.size(); ++k) shifted.push_back(&padded[k]);
        weigh_rows(&result[size_t(y) * size_t(width)], shifted, kernel, size_t(width));
    });
    return result;
}

std::vector<float> filter_columns(const std::vector<float>& source, int width, int height,
                                  std::span<const float> kernel)
{
    const int          radius = int(kernel.size() / 2);
    std::vector<float> result(source.size());
    parallel_rows(height, threads_for(width, height), [&](int y) {
        std::vector<const float*> rows;
        for (int k = 0; k < int(kernel.size()); ++k)
            rows.push_back(&source[size_t(std::clamp(y + k - radius, 0, height - 1)) * size_t(width)]);
        weigh_rows(&result[size_t(y) * size_t(width)], rows, kernel, size_t(width));
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
