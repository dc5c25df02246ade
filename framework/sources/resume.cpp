// The frame again, for rays that it stopped behind something: from where they may meet anything at all, if the frame
// shows that place.
#include "frame/passes/pass_helpers.h"
#include "sources/gbuffer_rays.h"

namespace ssrlab {
namespace {

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn           turn;
    std::vector<OpenRay> stopped;
    std::vector<size_t>  places;
    for (size_t k = 0; k < rays.size(); ++k) {
        turn.answers.push_back({.kind = AnswerKind::open, .clear_m = rays[k].clear_m});
        // Without a clear distance the frame did not follow the ray in sight.
        if (context.traced.status[rays[k].pixel] != TraceStatus::stopped || rays[k].clear_m == 0) continue;
        stopped.push_back(rays[k]);
        places.push_back(k);
    }
    GBufferTrace trace =
        trace_in_gbuffer(context, context.stage.gbuffer, context.image, context.trace, RayStart::if_shown, stopped);
    turn.trace_ms = trace.ms + cross_empty_cells(trace.answers, context, stopped);
    for (size_t k = 0; k < stopped.size(); ++k) turn.answers[places[k]] = trace.answers[k];
    return turn;
}

} // namespace

Source resume_source()
{
    return {.id      = "resume",
            .summary = "The frame again, for rays that it stopped, beyond the empty space behind what they passed",
            .answer  = answer};
}

} // namespace ssrlab
