// Structural similarity: Wang, Bovik, Sheikh, Simoncelli 2004, Image Quality Assessment: From Error Visibility to Structural
// Similarity. Gaussian window of 11 x 11 pixels, sigma 1.5, K1 = 0.01, K2 = 0.03, range 1.
#pragma once

#include "compare/image_filter.h"

namespace ssrlab {

/// The index in [-1, 1] around each pixel. Unlike the paper, windows at the border are kept; the border pixel continues outside.
std::vector<float> ssim_map(const Plane& a, const Plane& b);

} // namespace ssrlab
