// Rays in a cube of frames about one point: a ray that leaves a face goes on in the face that it enters.
#pragma once

#include "sources/gbuffer_rays.h"

#include <array>

namespace ssrlab {

struct CubeOfFrames {
    View centre; // its position and axes; faces look along +x, -x, +y, -y, +z, -z of its view space
    int  size_px = 512;
    std::array<GBufferPtr, 6>   faces;  // empty until a ray enters one
    std::array<GBufferImage, 6> images; // the same on the host
};

/// 90 degrees wide, as a square of so many pixels.
View face_view(const View& centre, int face, int size_px);

/// Draws the faces that rays enter, and adds what drawing and tracing took to the turn. Entry by entry of `rays`.
std::vector<RayAnswer> trace_in_cube(SourceContext& context, CubeOfFrames& cube, const TraceSettings& settings,
                                     RayStart start, std::span<const OpenRay> rays, SourceTurn& turn);

} // namespace ssrlab
