#include "sources/answered_frame.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "frame/frame_inputs.h"

#include <limits>

namespace ssrlab {
namespace {

/// The direction of a ray of the frame's list, in view space and unit length. A ray that ends where it begins has none:
/// the result is not finite.
glm::dvec3 direction_vs(const View& view, const RayInput& ray)
{
    const glm::dvec3 from = ray.origin_px_depth, delta = ray.delta_px_depth;
    if (view.projection == Projection::orthographic)
        return glm::normalize(px_to_vs(view, glm::dvec2(from + delta), from.z + delta.z) -
                              px_to_vs(view, glm::dvec2(from), from.z));
    // The difference of slope / depth at both ends, times both depths: that of the far end may be 0.
    const auto slope = [&](glm::dvec2 px, double z) {
        return glm::dvec3(px.x, -px.y, z) / glm::dvec3(view.focal_px, 1);
    };
    return glm::normalize(slope(delta, 0) * from.z - slope(glm::dvec2(from) - view.centre_px, -1) * delta.z);
}

/// Makes ray `number` of each pixel those that the context asks about, and returns their places in the list.
std::vector<size_t> take_rays(SourceContext& context, const FrameRays& frame, int number)
{
    const View&         view          = context.image.view;
    const glm::dmat4    view_to_world = glm::inverse(view.world_to_view);
    std::vector<size_t> places;
    context.traced = make_trace_image(view.size_px, false);
    context.rays.clear();
    for (size_t k = static_cast<size_t>(number); k < frame.rays.size(); k += static_cast<size_t>(frame.per_pixel)) {
        const RayInput&   ray       = frame.rays[k];
        const RayOutcome& outcome   = frame.outcomes[k];
        const size_t      i         = pixel_index(ray.pixel, view.size_px);
        const glm::dvec3  towards   = direction_vs(view, ray);
        const glm::dvec3  origin_vs = px_to_vs(view, glm::dvec2(ray.origin_px_depth), ray.origin_px_depth.z);
        if (!std::isfinite(glm::dot(towards, towards))) continue;
        context.traced.status[i]       = outcome.status;
        context.traced.hit_pixel[i]    = outcome.hit_pixel;
        context.traced.hit_layer[i]    = outcome.hit_layer;
        context.traced.hit_t[i]        = outcome.t;
        context.traced.hit_px_depth[i] = ray.origin_px_depth + outcome.t * ray.delta_px_depth;
        const double eye_m = view.projection == Projection::perspective ? glm::length(origin_vs) : -origin_vs.z;
        context.rays.push_back({i, glm::dvec3(view_to_world * glm::dvec4(origin_vs, 1)),
                                glm::dmat3(view_to_world) * towards, eye_m, 0, context.trace.max_distance_m,
                                double(context.image.roughness[i])});
        places.push_back(k);
    }
    return places;
}

RayLight to_light(const OpenRay& ray, const RayAnswer& answer, std::span<const ListedSource> sources)
{
    constexpr float nothing_m = std::numeric_limits<float>::infinity();
    if (answer.kind == AnswerKind::nothing && answer.certain) return {glm::vec3(0), nothing_m};
    const bool has_light = answer.kind == AnswerKind::point || answer.kind == AnswerKind::light;
    if (!has_light || sources[answer.source].source->id == "frame") return {};
    return {answer.light, static_cast<float>(glm::distance(answer.point_ws, ray.origin_ws))};
}

} // namespace

FrameTimes run_answered_frame(SourceContext& context, ReadyFrame& frame, std::span<const ListedSource> sources,
                              HandOn hand_on)
{
    if (runs(frame.inputs.plan, "hidden_layer"))
        throw_spec_error("hidden_layer = true: expected false beside sources; the source 'layers' asks further layers");
    Gpu&       gpu = context.stage.gpu;
    FrameRays  rays;
    FrameTimes times = trace_frame(gpu, frame, rays);
    context.trace_ms = times.total_ms();
    std::vector<RayLight> lights(rays.rays.size());
    for (int number = 0; number < rays.per_pixel; ++number) {
        const std::vector<size_t> places   = take_rays(context, rays, number);
        const AnsweredRays        answered = answer_rays(context, sources, hand_on);
        for (size_t k = 0; k < places.size(); ++k)
            lights[places[k]] = to_light(context.rays[k], answered.answers[context.rays[k].pixel], sources);
    }
    const FrameTimes shaded = shade_frame(gpu, frame, rays, lights);
    times.passes_ms.insert(times.passes_ms.end(), shaded.passes_ms.begin(), shaded.passes_ms.end());
    return times;
}

} // namespace ssrlab
