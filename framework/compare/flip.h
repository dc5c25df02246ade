// LDR FLIP: how different two pictures look when a viewer flips between them.
// P. Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images".
#pragma once

#include "compare/image_filter.h"
#include "core/image.h"

#include <array>

namespace ssrlab {

/// The paper's viewing conditions: a 0.7 m wide monitor of 3840 pixels, seen from 0.7 m.
inline constexpr float flip_pixels_per_degree = 67.0206433F;

/// What a viewer sees of an image, per pixel: the perceived colour, and the strength of edges and points.
struct FlipView {
    float                  pixels_per_degree = flip_pixels_per_degree;
    std::array<Plane, 3>   ycxcz; // the image itself
    std::vector<glm::vec3> lab;   // with the Hunt effect
    std::vector<float>     edges, points;
};
/// Throws Failure unless the image has three channels.
void require_three_channels(const Image& image);
/// Throws Failure if the sizes differ.
void require_same_size(glm::ivec2 a_px, glm::ivec2 b_px);

/// Views an image with channels R, G, B, sRGB-encoded, in [0, 1]. Throws Failure unless it has three channels.
FlipView flip_view(const Image& image, float pixels_per_degree = flip_pixels_per_degree);

/// Views a picture that shows `image` inside the mask and the reference outside; the result is 0 outside. Throws
/// Failure as flip_view() does, and if the sizes differ.
FlipView flip_view_inside(const Image& image, const FlipView& reference, const Mask& mask);

/// Returns one value in [0, 1] per pixel, 0 outside the mask. Throws Failure if the sizes differ.
std::vector<float> flip_error(const FlipView& tested, const FlipView& reference, const Mask& mask = {});

} // namespace ssrlab
