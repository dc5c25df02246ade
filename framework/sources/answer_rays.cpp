#include "sources/answer_rays.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "core/quantile.h"
#include "core/stopwatch.h"
#include "frame/scene_pictures.h"
#include "trace/lab_passes.h"

namespace ssrlab {
namespace {

/// The mirror direction at a pixel that reflects, in view space and unit length.
glm::dvec3 mirrored_vs(const GBufferImage& image, size_t pixel, glm::dvec3 point_vs)
{
    const glm::dvec3 normal = glm::normalize(glm::dvec3(image.normal_vs[pixel]));
    const glm::dvec3 sight =
        image.view.projection == Projection::perspective ? glm::normalize(point_vs) : glm::dvec3(0, 0, -1);
    return glm::normalize(sight - 2 * glm::dot(sight, normal) * normal);
}

/// The mirror rays of all pixels that reflect.
std::vector<OpenRay> mirror_rays(const SourceContext& context)
{
    const GBufferImage&  image         = context.image;
    const glm::dmat4     view_to_world = glm::inverse(image.view.world_to_view);
    std::vector<OpenRay> rays;
    for (size_t i = 0; i < image.depth.size(); ++i) {
        if (context.traced.status[i] == TraceStatus::not_traced) continue;
        const glm::dvec3 point_vs =
            px_to_vs(image.view, glm::dvec2(pixel_at(i, image.view.size_px)) + 0.5, double(image.depth[i]));
        const double eye_m = image.view.projection == Projection::perspective ? glm::length(point_vs) : -point_vs.z;
        rays.push_back({i, glm::dvec3(view_to_world * glm::dvec4(point_vs, 1)),
                        glm::dmat3(view_to_world) * mirrored_vs(image, i, point_vs), eye_m, 0,
                        context.trace.max_distance_m, double(image.roughness[i])});
    }
    return rays;
}

bool is_handed_on(const RayAnswer& answer, HandOn hand_on)
{
    return answer.kind == AnswerKind::open || answer.kind == AnswerKind::light ||
           (hand_on == HandOn::uncertain && !answer.certain);
}

} // namespace

SourceContext make_source_context(Stage& stage, const LabPtr& lab)
{
    if (stage.scene.frame)
        throw_failure("'{}' is a frame of another renderer: it has no triangles that further sources could answer from",
                      stage.scene.name);
    return {stage, lab, lab->settings, read_gbuffer(stage.gpu, *stage.gbuffer), {}, {}, {}, 0, 0, {}, {}};
}

SourceContext make_source_context(Stage& stage, const Technique& technique, const ParameterValues& values,
                                  const FrameSettings& settings)
{
    const LabPtr          lab     = make_lab(stage, technique, values, settings.trace);
    SourceContext         context = make_source_context(stage, lab);
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    const FramePtr        frame   = make_frame(stage.gpu, lab, buffers, plan_frame(stage, lab, buffers, settings));
    context.traced                = trace_gbuffer(stage.gpu, *make_tracer(stage.gpu, lab));
    context.rays                  = mirror_rays(context);
    run_frame(stage.gpu, *frame);
    std::vector<double> draw_ms, times_ms;
    for (int turn = 0; turn < 3; ++turn) {
        draw_ms.push_back(redraw_gbuffer(stage.gpu, *stage.drawing));
        double& time_ms = times_ms.emplace_back(0);
        for (const auto& [pass, ms] : run_frame(stage.gpu, *frame).passes_ms) {
            time_ms += ms;
            if (pass == "trace") break; // what follows shades
        }
    }
    context.draw_ms  = quantile(draw_ms, 0.5);
    context.trace_ms = quantile(times_ms, 0.5);
    return context;
}

AnsweredRays answer_rays(SourceContext& context, std::span<const ListedSource> sources, HandOn hand_on)
{
    std::vector<OpenRay> rays = context.rays;
    AnsweredRays         result;
    result.answers.resize(context.image.depth.size());
    for (const OpenRay& ray : rays) result.answers[ray.pixel].kind = AnswerKind::open;
    for (const ListedSource& listed : sources) {
        const Stopwatch choosing;
        std::erase_if(rays, [&](const OpenRay& ray) { return !is_handed_on(result.answers[ray.pixel], hand_on); });
        for (OpenRay& ray : rays) ray.clear_m = result.answers[ray.pixel].clear_m;
        const double chosen_ms = 1000 * choosing.seconds();
        context.parameters     = listed.values;
        SourceTurn turn        = rays.empty() ? SourceTurn{} : listed.source->answer(context, rays);
        turn.source            = listed.text;
        const Stopwatch merging;
        for (size_t k = 0; k < rays.size(); ++k) {
            turn.pixels.push_back(rays[k].pixel);
            turn.answers[k].source        = static_cast<uint8_t>(result.turns.size());
            result.answers[rays[k].pixel] = merged(result.answers[rays[k].pixel], turn.answers[k]);
        }
        turn.merge_ms += chosen_ms + 1000 * merging.seconds();
        result.turns.push_back(std::move(turn));
    }
    return result;
}

} // namespace ssrlab
