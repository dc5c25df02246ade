// LDR FLIP: how different two pictures look when a viewer flips between them.
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020: FLIP: A Difference Evaluator for Alternating Images.
#pragma once

#include "core/image.h"

namespace ssrlab {

/// The paper's viewing conditions: a 0.7 m wide monitor of 3840 pixels, seen from 0.7 m.
inline constexpr float flip_pixels_per_degree = 67.0206433F;

/// What a viewer sees of an image, per pixel: the perceived colour, and how strongly edges and points stand out.
struct FlipView {
    glm::ivec2             size_px{0, 0};
    std::vector<glm::vec3> lab; // with the Hunt effect
    std::vector<float>     edges, points;
};
/// Channels R, G, B, sRGB-encoded, values in [0, 1]. Throws Failure unless there are three values a pixel.
FlipView flip_view(const Image& image, float pixels_per_degree = flip_pixels_per_degree);

/// One value in [0, 1] per pixel. Throws Failure when the sizes differ.
std::vector<float> flip_error(const FlipView& tested, const FlipView& reference);

} // namespace ssrlab
