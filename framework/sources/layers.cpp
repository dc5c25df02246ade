// Further layers of the frame by depth peeling, of the sides that face the camera or of both: a back face is a surface
// that a ray may meet from its outer side.
#include "core/stopwatch.h"
#include "frame/both_sides.h"
#include "frame/passes/pass_helpers.h"
#include "sources/gbuffer_rays.h"
#include "world/grid_walk.h"

namespace ssrlab {
namespace {

/// The frame again, with its layers. A drawing refers to those before it, so all are kept.
struct Layered {
    DrawingPtr              first;
    std::vector<DrawingPtr> further;
};

/// Draws where the solids of a layer end; returns the GPU's time.
double draw_solids_ms(Gpu& gpu, Drawing& layer)
{
    make_solid_backs(gpu, layer); // a driver may compile a pipeline when it first draws
    const Timestamps timestamps = make_timestamps(gpu, 2);
    submit(gpu, [&](const Commands& commands) {
        write_timestamp(commands, timestamps, 0);
        record_solid_backs(commands, layer);
        write_timestamp(commands, timestamps, 1);
    });
    return read_intervals_ms(gpu, timestamps)[0];
}

Layered draw_layered(SourceContext& context, int layers, bool both_sides, SourceTurn& turn)
{
    Gpu&    gpu = context.stage.gpu;
    Layered drawn{draw_gbuffer(gpu, context.stage.uploaded, context.image.view), {}};
    turn.draw_ms = draw_solids_ms(gpu, *drawn.first);
    for (int layer = 1; layer < layers; ++layer) {
        const Drawing& before = drawn.further.empty() ? *drawn.first : *drawn.further.back();
        Drawing&       own =
            *drawn.further.emplace_back(both_sides ? make_next_side(gpu, before) : make_next_layer(gpu, before));
        redraw_gbuffer(gpu, own); // a driver may compile a pipeline when it first draws
        turn.draw_ms += redraw_gbuffer(gpu, own) + draw_solids_ms(gpu, own);
        turn.megabytes += megabytes_of(*own.gbuffer);
        drawn.first->gbuffer->layers.push_back(own.gbuffer);
    }
    return drawn;
}

/// Is an answer's point in doubt? It is if it lies where the ray is known to be clear, or if the ray may have met
/// something before it that no layer shows. What the grid says of the cells around the point may be the point itself.
bool is_doubtful(const GBufferImage& last_layer, const Occupancy& grid, const OpenRay& ray, glm::dvec3 point_ws)
{
    constexpr double own_cells = 2;
    const double     met_m     = glm::distance(point_ws, ray.origin_ws);
    return met_m < ray.clear_m ||
           may_meet_behind(last_layer, grid, ray, met_m - own_cells * across_cell_m(grid, ray.direction_ws));
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn         turn;
    const auto         layers     = static_cast<int>(context.parameters.at("count"));
    const bool         both_sides = context.parameters.at("sides") == 1;
    const Layered      drawn      = draw_layered(context, layers, both_sides, turn);
    const GBufferPtr&  gbuffer    = drawn.first->gbuffer;
    const GBufferImage image      = read_gbuffer(context.stage.gpu, *gbuffer);
    // What is seen edge-on fills no pixel, but it bounds a solid that the ray enters. Where back faces are left out, a ray
    // that comes from behind a front has met one.
    TraceSettings settings = context.trace;
    settings.surface       = both_sides ? "plane_sides" : "plane_solid";
    settings.behind        = both_sides ? Behind::hit : Behind::stop;
    settings.layers        = layers;
    // Techniques leave the start pixel out, where a ray that begins in mid-air may meet any layer.
    std::vector<OpenRay> begun(rays.begin(), rays.end());
    for (OpenRay& ray : begun) ray.clear_m = before_clear_end_m(image.view, ray);
    GBufferTrace trace = trace_in_gbuffer(context, gbuffer, image, settings, RayStart::anywhere, begun);
    turn.answers       = std::move(trace.answers);
    turn.trace_ms      = trace.ms;

    const Occupancy& grid = grid_of(context.stage).grid;
    const Stopwatch  merging;
    for (size_t k = 0; k < rays.size(); ++k) {
        RayAnswer& answer = turn.answers[k];
        if (answer.kind == AnswerKind::point && is_doubtful(image.layers.back(), grid, rays[k], answer.point_ws))
            answer = {.kind = AnswerKind::open};
        answer.clear_m = rays[k].clear_m;
    }
    turn.merge_ms = 1000 * merging.seconds();
    return turn;
}

} // namespace

Source layers_source()
{
    return {.id         = "layers",
            .summary    = "Further layers of the frame by depth peeling, of one side or of both",
            .cite       = {"C. Everitt 2001, Interactive Order-Independent Transparency",
                           "M. Mara et al. 2016, Deep G-Buffers for Stable Global Illumination Approximation"},
            .parameters = {integer_parameter("count", 4, 2, MAX_LAYERS, "layers in all, the frame's own included"),
                           choice_parameter({"sides", "front, both"}, 1,
                                            "front: sides that face the camera; both: back faces, too")},
            .answer     = answer};
}

} // namespace ssrlab
