// Pictures for people: exposure, display transform, pictures side by side. Measurements use linear radiance instead.
//
// agx is the base look of AgX (Troy Sobotka 2022) in the fit by B. Wrensch 2023, "Minimal AgX Implementation": inset
// matrix, log2 exposure over 16.5 stops around grey, contrast polynomial of degree 6, outset matrix, a power of 2.2.
#pragma once

#include "core/image.h"

#include <span>

namespace ssrlab {

struct Display {
    enum class Transform { clip, agx };

    double    exposure_ev = 0; // the radiance is multiplied by 2^exposure_ev
    Transform transform   = Transform::clip;
};

/// Converts linear radiance to linear display light in [0, 1] (sRGB primaries); NaN gives 0. Three channels.
Image to_display(const Image& radiance, const Display& display);

/// Returns the mean of `count` pictures from their sum.
Image mean_of(Image sum, int count);
/// Adds the image to `sum`, which may be empty.
void add_to(Image& sum, const Image& image);

struct LabelledImage {
    std::string label;
    Image       image;
};
/// Puts pictures of one size and three channels side by side, each below its label. Throws Failure if there is no font.
Image side_by_side(std::span<const LabelledImage> pictures);

} // namespace ssrlab
