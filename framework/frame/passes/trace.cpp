// The technique.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

RecordFunction prepare(Gpu& /*gpu*/, const PassContext& context)
{
    return [&trace = context.frame.trace.technique.trace, &rays = ray_launch(context)](const auto& commands) {
        dispatch_indirect(commands, trace, rays);
    };
}

} // namespace

Pass trace_pass()
{
    return {.id      = "trace",
            .summary = "Runs the technique on the list of rays",
            .reads   = {Resource::gbuffer, Resource::layers, Resource::solids, Resource::structures, Resource::rays},
            .writes  = {Resource::hits},
            .decide  = needed_if_anything_reflects,
            .prepare = prepare};
}

} // namespace ssrlab
