// The scene's triangles: ray tracing, for the rays that everything cheaper left open.
#include "world/world.h"
#include "frame/passes/pass_helpers.h"
#include "frame/world_light.h"
#include "sources/gbuffer_rays.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ssrlab {
namespace {

RayAnswer to_answer(const SourceContext& context, const OpenRay& ray, const WorldHit& hit)
{
    RayAnswer answer{.kind = AnswerKind::open, .clear_m = ray.clear_m};
    if (hit.triangle == walk_unfinished) return answer;
    answer.certain = true;
    if (hit.triangle == no_triangle) {
        set_nothing(answer, context, ray, true);
        return answer;
    }
    answer.kind     = AnswerKind::point;
    answer.point_ws = ray.origin_ws + double(hit.t) * ray.direction_ws;
    return answer;
}

/// Adds what the scene's reflecting surfaces show to the light of the answers, one bounce after the other.
void follow_reflections(SourceContext& context, std::vector<WorldRay> rays, std::vector<WorldHit> hits,
                        SourceTurn& turn)
{
    Gpu&                   gpu     = context.stage.gpu;
    const int              bounces = static_cast<int>(context.parameters.at("bounces"));
    const World&           world   = *world_of(context.stage);
    const SampledTable     table   = upload_dfg_table(gpu);
    std::vector<size_t>    owners(rays.size()); // of each ray: the answer
    std::vector<glm::vec3> weights(rays.size(), glm::vec3(1));
    std::iota(owners.begin(), owners.end(), 0);
    for (int bounce = 0; !rays.empty(); ++bounce) {
        const WorldLight shaded =
            shade_world(gpu, world, *context.stage.uploaded, table, context.trace, bounce < bounces, rays, hits);
        (bounce == 0 ? turn.shade_ms : turn.bounces_ms) += shaded.ms;
        std::vector<WorldRay>  next_rays;
        std::vector<size_t>    next_owners;
        std::vector<glm::vec3> next_weights;
        for (size_t k = 0; k < rays.size(); ++k) {
            glm::vec3& light = turn.answers[owners[k]].light;
            if (hits[k].triangle == no_triangle && bounce > 0)
                light += weights[k] * sky_radiance(context.stage.scene, glm::dvec3(rays[k].direction_ws));
            if (hits[k].triangle >= walk_unfinished) continue;
            light += weights[k] * shaded.light[k];
            if (shaded.next[k].weight == glm::vec3(0)) continue;
            next_rays.push_back(shaded.next[k].ray);
            next_owners.push_back(owners[k]);
            next_weights.push_back(weights[k] * shaded.next[k].weight);
        }
        rays    = std::move(next_rays);
        owners  = std::move(next_owners);
        weights = std::move(next_weights);
        if (rays.empty()) break;
        WorldTrace trace = trace_world(gpu, world, rays);
        turn.bounces_ms += trace.ms;
        hits = std::move(trace.hits);
    }
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    const World&          world = *world_of(context.stage);
    std::vector<WorldRay> listed;
    for (const OpenRay& ray : rays)
        listed.push_back(to_world_ray(ray, std::max(ray.clear_m, world_start_share * ray.eye_m)));
    const WorldTrace trace = trace_world(context.stage.gpu, world, listed);
    SourceTurn       turn;
    for (size_t k = 0; k < rays.size(); ++k) turn.answers.push_back(to_answer(context, rays[k], trace.hits[k]));
    follow_reflections(context, std::move(listed), trace.hits, turn);
    turn.trace_ms    = trace.ms;
    turn.node_visits = trace.node_visits;
    turn.megabytes   = double(world.bytes) / 1e6;
    return turn;
}

} // namespace

Source world_source()
{
    return {
        .id         = "world",
        .summary    = "The scene's triangles, in a hierarchy that a shader walks",
        .cite       = {"I. Wald et al. 2014, Embree: A Kernel Framework for Efficient CPU Ray Tracing",
                       "T. Ize 2013, Robust BVH Ray Traversal, JCGT 2(2)"},
        .parameters = {integer_parameter("bounces", 2, 0, 16, "reflections that are followed at what the rays meet")},
        .answer     = answer};
}

} // namespace ssrlab
