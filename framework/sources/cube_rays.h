// Rays in a cube of frames around one point: a ray that leaves a face continues in the face that it enters.
#pragma once

#include "frame/both_sides.h"
#include "sources/gbuffer_rays.h"

#include <array>

namespace ssrlab {

struct CubeOfFrames {
    View centre; // its position and axes; faces look along +x, -x, +y, -y, +z, -z of its view space
    int  size_px                                 = 512;
    std::array<GBufferPtr, 6>           faces    = {}; // empty until a ray enters one
    std::array<GBufferImage, 6>         images   = {}; // the same on the host
    std::shared_ptr<const DrawPipeline> pipeline = {}; // empty until a face is drawn
};

/// Returns the view from another place, with the same axes.
View moved_to(const View& view, glm::dvec3 eye_ws);

/// Returns the face that shows a point of the centre's view space.
int face_toward(glm::dvec3 point_vs);

/// Draws both sides of all surfaces in a face, unless that was done before. Adds time and memory to the turn.
void draw_face(SourceContext& context, CubeOfFrames& cube, int face, SourceTurn& turn);

/// Returns the square view of a face, 90 degrees wide.
View face_view(const View& centre, int face, int size_px);

/// Draws both sides of all surfaces in the faces that rays enter, and traces: an answer per ray. Adds its times.
std::vector<RayAnswer> trace_in_cube(SourceContext& context, CubeOfFrames& cube, const TraceSettings& settings,
                                     RayStart start, std::span<const OpenRay> rays, SourceTurn& turn);

} // namespace ssrlab
