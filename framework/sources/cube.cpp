// Frames for all directions at the camera's position: a ray that leaves the picture goes on in the face that it enters.
#include "frame/passes/pass_helpers.h"
#include "sources/cube_rays.h"

namespace ssrlab {
namespace {

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn   turn;
    CubeOfFrames cube{context.image.view, static_cast<int>(context.parameters.at("size_px"))};
    turn.answers = trace_in_cube(context, cube, context.trace, RayStart::from_frame, rays, turn);
    return turn;
}

} // namespace

Source cube_source()
{
    return {.id         = "cube",
            .summary    = "Frames of all directions at the camera's position; only faces that rays enter are drawn",
            .parameters = {integer_parameter("size_px", 512, 16, 4096, "width and height of a face")},
            .answer     = answer};
}

} // namespace ssrlab
