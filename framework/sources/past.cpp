// Frames that were drawn before this one: a camera that moved has seen other sides. They cost memory and no drawing.
#include "core/error.h"
#include "frame/drawing.h"
#include "frame/passes/pass_helpers.h"
#include "scene/sequence.h"
#include "sources/gbuffer_rays.h"

namespace ssrlab {
namespace {

/// Drawn anew: where nothing moves but the camera, it is what was kept.
void ask_frame(SourceContext& context, const View& view, std::span<const OpenRay> rays, SourceTurn& turn)
{
    const DrawingPtr   drawing = draw_gbuffer(context.stage.gpu, context.stage.uploaded, view);
    const GBufferPtr   gbuffer = gbuffer_of(*drawing);
    const GBufferImage image   = read_gbuffer(context.stage.gpu, *gbuffer);
    turn.megabytes += megabytes_of(*gbuffer);
    ask_elsewhere(context, rays, turn.answers,
                  [&](const TraceSettings& settings, RayStart start, std::span<const OpenRay> open) {
                      GBufferTrace trace = trace_in_gbuffer(context, gbuffer, image, settings, start, open);
                      turn.trace_ms += trace.ms;
                      return std::move(trace.answers);
                  });
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    if (anything_moves(context.stage.first))
        throw_failure("source 'past': objects of '{}' move; expected a scene in which only the camera does",
                      context.stage.scene.name);
    SourceTurn turn;
    for (const OpenRay& ray : rays) turn.answers.push_back({.kind = AnswerKind::open, .clear_m = ray.clear_m});
    const auto count = static_cast<size_t>(context.parameters.at("count"));
    const auto every = static_cast<size_t>(context.parameters.at("every"));
    for (size_t kept = 1; kept <= count && kept * every <= context.earlier.size(); ++kept)
        ask_frame(context, context.earlier[kept * every - 1], rays, turn);
    return turn;
}

} // namespace

Source past_source()
{
    return {.id         = "past",
            .summary    = "Earlier frames of the camera's path; nothing but the camera may move",
            .parameters = {integer_parameter("count", 8, 1, 64, "frames that are kept"),
                           integer_parameter("every", 4, 1, 256, "frames from one that is kept to the next")},
            .answer     = answer};
}

} // namespace ssrlab
