// ssrlab render: a picture with reflections, without them, with the true ones, or all three side by side.
#pragma once

#include "app/commands.h"
#include "compare/display.h"

namespace ssrlab {

/// How a picture is presented: off by default, for what is measured has no such thing. Only a .png has a display.
struct RenderOptions {
    PictureOptions picture;
    int            frames      = 0; // so many pictures from frame picture.at.frame on; 0: one, without a number
    int            samples     = 1; // places of the camera within a pixel, whose pictures are averaged
    double         exposure_ev = 0;
    std::string    display     = "clip"; // or agx
    std::string    show; // false colours in the picture's place: agreement, causes, fetches, sources; empty: none
    std::string    sources; // asked about the rays, in this order; empty: the frame alone, or "frame,world" to show
    bool           truth = false, side_by_side = false;
    bool           errors = false; // of the traced picture: printed
};

inline constexpr int max_samples = 256;

int render_picture(const CommonOptions& common, const RenderOptions& options);

} // namespace ssrlab
