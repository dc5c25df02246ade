// Structural similarity: Z. Wang et al. 2004, "Image Quality Assessment: From Error Visibility to Structural
// Similarity". Gaussian window of 11 x 11 pixels, sigma 1.5, K1 = 0.01, K2 = 0.03, range 1.
#pragma once

#include "compare/image_filter.h"

namespace ssrlab {

/// Luma of a picture, and the mean of it and of its square in the window around each pixel.
struct SsimView {
    Plane luma, mean, mean_square;
};
SsimView ssim_view(Plane luma);

/// Returns the index in [-1, 1] around each pixel, 0 outside the mask. Unlike the paper, windows at the border are
/// kept; the border pixel continues outside. Sizes must be equal.
std::vector<float> ssim_map(const SsimView& a, const SsimView& b, const Mask& mask = {});

} // namespace ssrlab
