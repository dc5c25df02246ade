#include "frame/world_light.h"

#include "gpu/timed_run.h"

namespace ssrlab {
namespace {

/// shaders/world/shade.comp, scalar layout.
struct ShadePush {
    glm::vec3 ambient;
    float     dielectric_min_f0;
    float     dielectric_max_roughness;
    uint32_t  follows;
};

} // namespace

ComputePass make_shade_pass(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                            const WorldRayList& list, const Buffer& hits, const Buffer& light, const Buffer& next)
{
    Bindings bindings = material_bindings(world);
    bindings.insert({{"WorldRays", list.rays},
                     {"WorldLaunch", list.launch},
                     {"WorldHits", hits},
                     {"WorldLight", light},
                     {"NextRays", next},
                     {"dfg_table", {dfg_table.image, dfg_table.sampler}},
                     {"Lights", scene.lights},
                     {"ShadowMatrices", scene.shadow_matrices},
                     {"shadow_map", {scene.shadow_map, scene.shadow_sampler}}});
    return make_compute_pass(gpu, compile_shader(gpu, {.file = "world/shade.comp"}), bindings, {}, sizeof(ShadePush));
}

void record_shade(const Commands& commands, const ComputePass& pass, const GpuScene& scene, const TraceSettings& trace,
                  bool follows, const Buffer& launch)
{
    push(commands, pass,
         ShadePush{scene.ambient, static_cast<float>(trace.dielectric_min_f0),
                   static_cast<float>(trace.dielectric_max_roughness), follows ? 1U : 0U});
    dispatch_indirect(commands, pass, launch);
}

WorldLight shade_world(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                       const TraceSettings& trace, bool follows, std::span<const WorldRay> rays,
                       std::span<const WorldHit> hits)
{
    WorldLight result;
    if (rays.empty() || world.tree.nodes.empty()) {
        result.light.resize(rays.size());
        result.next.resize(rays.size());
        return result;
    }
    const WorldRayList list  = make_ray_list(gpu, rays);
    const Buffer       found = make_buffer_with<WorldHit>(gpu, hits);
    const Buffer       light = make_buffer(gpu, rays.size() * sizeof(glm::vec3));
    const Buffer       next  = make_buffer(gpu, rays.size() * sizeof(NextRay));
    const ComputePass  pass  = make_shade_pass(gpu, world, scene, dfg_table, list, found, light, next);
    result.ms                = time_second_run_ms(
                       gpu, [&](const Commands& commands) { record_shade(commands, pass, scene, trace, follows, list.launch); });
    result.light = download_as<glm::vec3>(gpu, light, rays.size());
    result.next  = download_as<NextRay>(gpu, next, rays.size());
    return result;
}

} // namespace ssrlab
