// LDR FLIP: how different two pictures look when a viewer flips between them.
// Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020: FLIP: A Difference Evaluator for Alternating Images.
#pragma once

#include "core/image.h"

namespace ssrlab {

/// The paper's viewing conditions: a 0.7 m wide monitor of 3840 pixels, seen from 0.7 m.
inline constexpr float flip_pixels_per_degree = 67.0206433F;

/// One value in [0, 1] per pixel. Both images: channels R, G, B, sRGB-encoded, values in [0, 1].
std::vector<float> flip_error(const Image& tested, const Image& reference,
                              float pixels_per_degree = flip_pixels_per_degree);

} // namespace ssrlab
