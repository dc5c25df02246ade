// The frame drawn with a margin: rays go on beyond the picture's border.
#include "frame/drawing.h"
#include "frame/passes/pass_helpers.h"
#include "sources/gbuffer_rays.h"

#include <cmath>

namespace ssrlab {
namespace {

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn       turn;
    View             view      = context.image.view;
    const glm::ivec2 margin_px = glm::ivec2(glm::ceil(glm::dvec2(view.size_px) * context.parameters.at("margin")));
    view.size_px += 2 * margin_px;
    view.centre_px += glm::dvec2(margin_px);
    const DrawingPtr drawing = draw_gbuffer(context.stage.gpu, context.stage.uploaded, view);
    const GBufferPtr gbuffer = gbuffer_of(*drawing);
    turn.draw_ms             = redraw_gbuffer(context.stage.gpu, *drawing);
    turn.megabytes           = megabytes_of(*gbuffer);
    GBufferTrace trace = trace_in_gbuffer(context, gbuffer, read_gbuffer(context.stage.gpu, *gbuffer), context.trace,
                                          RayStart::from_frame, rays);
    turn.answers       = std::move(trace.answers);
    turn.trace_ms      = trace.ms;
    return turn;
}

} // namespace

Source wider_source()
{
    return {.id         = "wider",
            .summary    = "The frame with a margin, traced beyond the picture's border",
            .parameters = {real_parameter("margin", 0.25, 0.01, 2,
                                          "on each side, as a share of the picture's width and height")},
            .answer     = answer};
}

} // namespace ssrlab
