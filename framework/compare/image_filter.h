// One channel of a picture, and separable filters over it.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace ssrlab {

struct Plane {
    glm::ivec2         size_px{0, 0};
    std::vector<float> values; // row-major
};

/// One byte per pixel, not 0 inside. An empty mask contains all pixels.
using Mask = std::vector<uint8_t>;
inline bool is_inside(const Mask& mask, size_t pixel) { return mask.empty() || mask[pixel] != 0; }

/// Returns sum over dx, dy of kernel_x[dx] kernel_y[dy] plane(x + dx, y + dy), with odd kernels and clamped borders.
Plane filter_separable(const Plane& plane, std::span<const float> kernel_x, std::span<const float> kernel_y);

float srgb_to_linear(float value);
float linear_to_srgb(float value); // clamps to [0, 1]; NaN gives 0

} // namespace ssrlab
