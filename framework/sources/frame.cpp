// The frame itself: what its own rays found, and how sure that is.
#include "core/pixel_index.h"
#include "core/stopwatch.h"
#include "frame/passes/pass_helpers.h"
#include "sources/gbuffer_rays.h"
#include "world/grid_walk.h"

namespace ssrlab {
namespace {

RayAnswer answer_of(const SourceContext& context, const OpenRay& ray, bool in_sight)
{
    const TraceImage& traced = context.traced;
    const size_t      i      = ray.pixel;
    const auto        part   = seen_part(context.image.view, ray);
    if (!part) return {.kind = AnswerKind::open};
    const RayOutcome outcome{
        .status = traced.status[i], .hit_pixel = traced.hit_pixel[i], .hit_layer = traced.hit_layer[i]};
    return to_answer(context, context.image, ray, *part, outcome, traced.hit_px_depth[i], in_sight);
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn      turn;
    const Stopwatch stopwatch;
    const bool      in_sight = stays_in_sight(context, context.trace);
    for (const OpenRay& ray : rays) turn.answers.push_back(answer_of(context, ray, in_sight));
    turn.merge_ms = 1000 * stopwatch.seconds();
    turn.trace_ms = context.trace_ms + cross_empty_cells(turn.answers, context, rays);
    if (in_sight) turn.megabytes = double(grid_of(context.stage).occupied.bytes) / 1e6;
    return turn;
}

} // namespace

Source frame_source()
{
    return {.id = "frame", .summary = "What the frame shows: its own rays, traced by the technique", .answer = answer};
}

} // namespace ssrlab
