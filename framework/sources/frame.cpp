// The frame itself: what its own rays found, and how sure that is.
#include "core/pixel_index.h"
#include "core/stopwatch.h"
#include "frame/passes/pass_helpers.h"
#include "sources/gbuffer_rays.h"
#include "world/occupancy.h"

namespace ssrlab {
namespace {

constexpr double back_px = 2; // a ray is followed again from so many pixels before where the frame lost it

RayAnswer answer_of(const SourceContext& context, const Occupancy& occupancy, const OpenRay& ray, bool in_sight)
{
    const GBufferImage& image  = context.image;
    const TraceImage&   traced = context.traced;
    const size_t        i      = ray.pixel;
    const TraceStatus   status = traced.status[i];
    RayAnswer           answer{.kind = AnswerKind::open};
    const auto          part = seen_part(image.view, ray);
    if (!part) return answer;
    if (status == TraceStatus::hit) {
        const int layer = traced.hit_layer[i];
        set_point(answer, layer == 0 ? image : image.layers[static_cast<size_t>(layer) - 1], traced.hit_pixel[i],
                  traced.hit_px_depth[i], in_sight);
    }
    if (status == TraceStatus::past_max_distance) set_nothing(answer, context, ray, in_sight);
    if (!in_sight) return answer;
    if (has_place(status)) answer.clear_m = metres_before(image.view, ray, *part, traced.hit_px_depth[i], back_px);
    if (status == TraceStatus::left_screen && part->leaves) {
        const RayInput input = to_input(image.view, ray, *part);
        answer.clear_m = metres_before(image.view, ray, *part, input.origin_px_depth + input.delta_px_depth, back_px);
    }
    if (answer.kind == AnswerKind::open && answer.clear_m > 0) cross_empty_cells(answer, context, occupancy, ray);
    return answer;
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn       turn;
    const Occupancy& occupancy = occupancy_of(context.stage);
    const Stopwatch  stopwatch;
    const bool       in_sight = stays_in_sight(context, context.trace);
    for (const OpenRay& ray : rays) turn.answers.push_back(answer_of(context, occupancy, ray, in_sight));
    turn.merge_ms = 1000 * stopwatch.seconds();
    turn.trace_ms = context.trace_ms;
    return turn;
}

} // namespace

Source frame_source()
{
    return {.id = "frame", .summary = "What the frame shows: its own rays, traced by the technique", .answer = answer};
}

} // namespace ssrlab
