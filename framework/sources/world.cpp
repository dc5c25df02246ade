// The scene's triangles: ray tracing, for the rays that everything cheaper left open.
#include "world/world.h"
#include "frame/passes/pass_helpers.h"
#include "sources/source.h"
#include "sources/world_light.h"

#include <algorithm>
#include <limits>

namespace ssrlab {
namespace {

// Of the distance to the eye: what a ray meets nearer to its origin is the surface that it leaves, for its depth is a
// rounded float.
constexpr double start_share = 1e-4;

WorldRay to_world_ray(const OpenRay& ray)
{
    const double start_m = std::max(ray.clear_m, start_share * ray.eye_m);
    return {glm::vec3(ray.origin_ws), static_cast<float>(start_m), glm::vec3(ray.direction_ws),
            static_cast<float>(std::min(ray.reach_m, double(std::numeric_limits<float>::max()) / 4))};
}

RayAnswer to_answer(const SourceContext& context, const OpenRay& ray, const WorldHit& hit)
{
    RayAnswer answer{.kind = AnswerKind::open, .clear_m = ray.clear_m};
    if (hit.triangle == walk_unfinished) return answer;
    answer.certain = true;
    if (hit.triangle == no_triangle) {
        answer.kind  = AnswerKind::nothing;
        answer.light = sky_radiance(context.stage.scene, ray.direction_ws);
        return answer;
    }
    answer.kind     = AnswerKind::point;
    answer.point_ws = ray.origin_ws + double(hit.t) * ray.direction_ws;
    return answer;
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    if (!context.world) context.world = upload_world(context.stage.gpu, context.stage.scene);
    std::vector<WorldRay> listed;
    for (const OpenRay& ray : rays) listed.push_back(to_world_ray(ray));
    const WorldTrace trace = trace_world(context.stage.gpu, *context.world, listed);
    SourceTurn       turn;
    for (size_t k = 0; k < rays.size(); ++k) turn.answers.push_back(to_answer(context, rays[k], trace.hits[k]));
    const WorldLight shaded =
        shade_world(context.stage.gpu, *context.world, *context.stage.uploaded, listed, trace.hits);
    for (size_t k = 0; k < rays.size(); ++k)
        if (turn.answers[k].kind == AnswerKind::point) turn.answers[k].light = shaded.light[k];
    turn.shade_ms    = shaded.ms;
    turn.trace_ms    = trace.ms;
    turn.node_visits = trace.node_visits;
    turn.megabytes   = double(context.world->bytes) / 1e6;
    return turn;
}

} // namespace

Source world_source()
{
    return {.id      = "world",
            .summary = "The scene's triangles, in a hierarchy that a shader walks",
            .cite    = {"I. Wald et al. 2014, Embree: A Kernel Framework for Efficient CPU Ray Tracing",
                        "T. Ize 2013, Robust BVH Ray Traversal, JCGT 2(2)"},
            .answer  = answer};
}

} // namespace ssrlab
