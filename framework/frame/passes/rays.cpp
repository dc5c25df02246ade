// The rays of each reflecting pixel.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

RecordFunction prepare(Gpu& /*gpu*/, const PassContext& context)
{
    return [&frame = context.frame](const auto& commands) {
        record_ray_setup(commands, frame.trace, *frame.lab->gbuffer);
    };
}

} // namespace

Pass rays_pass()
{
    return {.id      = "rays",
            .summary = "Sets up the rays of each reflecting pixel",
            .cite    = {"J. Somerville Roberts, Screen Space Reflections"},
            .reads   = {Resource::gbuffer, Resource::tiles},
            .writes  = {Resource::rays},
            .parameters =
                {integer_parameter(
                     "rays_per_pixel", 1, 1, 16,
                     "rays per pixel, from random positions inside the pixel; 1: one ray from its centre. More "
                     "than half must hit, or the pixel counts as a miss. A ray off the centre may hit a "
                     "neighbouring pixel of its own surface; ray_offset_m prevents this"),
                 choice_parameter(TraceResolution::full,
                                  "pixels with rays: every reflecting pixel, or one in each block of 2 x 2 "
                                  "(half) or 4 x 4 (quarter), the reflecting pixel nearest to the block's centre"),
                 choice_parameter(RayList::rays,
                                  "what the list of rays holds. rays: each ready to trace, 32 bytes; pixels: its "
                                  "pixel, 4 bytes, and whoever reads the ray makes it anew. The picture is the same")},
            .decide  = needed_if_anything_reflects,
            .prepare = prepare};
}

} // namespace ssrlab
