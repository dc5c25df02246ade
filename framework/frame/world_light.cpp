#include "frame/world_light.h"

namespace ssrlab {
namespace {

/// shaders/world/shade.comp, scalar layout.
struct ShadePush {
    glm::vec3 ambient;
    uint32_t  ray_count;
    int32_t   light_count;
    float     dielectric_min_f0;
    float     dielectric_max_roughness;
    uint32_t  follows;
};

} // namespace

ComputePass make_shade_pass(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                            const Buffer& rays, const Buffer& hits, const Buffer& light, const Buffer& next)
{
    Bindings bindings = material_bindings(world);
    bindings.insert({{"WorldRays", rays},
                     {"WorldHits", hits},
                     {"WorldLight", light},
                     {"NextRays", next},
                     {"dfg_table", {dfg_table.image, dfg_table.sampler}},
                     {"Lights", scene.lights},
                     {"ShadowMatrices", scene.shadow_matrices},
                     {"shadow_map", {scene.shadow_map, scene.shadow_sampler}}});
    return make_compute_pass(gpu, compile_shader(gpu, {.file = "world/shade.comp"}), bindings, {}, sizeof(ShadePush));
}

void record_shade(const vk::raii::CommandBuffer& commands, const ComputePass& pass, const GpuScene& scene,
                  const TraceSettings& trace, bool follows, uint32_t ray_count)
{
    push(commands, pass,
         ShadePush{scene.ambient, ray_count, static_cast<int32_t>(scene.light_count),
                   static_cast<float>(trace.dielectric_min_f0), static_cast<float>(trace.dielectric_max_roughness),
                   follows ? 1U : 0U});
    dispatch(commands, pass, groups_for(ray_count));
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
    const Buffer      listed = make_buffer_with<WorldRay>(gpu, rays), found = make_buffer_with<WorldHit>(gpu, hits);
    const Buffer      light      = make_buffer(gpu, rays.size() * sizeof(glm::vec3));
    const Buffer      next       = make_buffer(gpu, rays.size() * sizeof(NextRay));
    const ComputePass pass       = make_shade_pass(gpu, world, scene, dfg_table, listed, found, light, next);
    const Timestamps  timestamps = make_timestamps(gpu, 2);
    for (int turn : {0, 1}) { // a driver may compile a pipeline when it first runs
        static_cast<void>(turn);
        submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
            barrier(commands);
            write_timestamp(commands, timestamps, 0);
            record_shade(commands, pass, scene, trace, follows, static_cast<uint32_t>(rays.size()));
            barrier(commands);
            write_timestamp(commands, timestamps, 1);
        });
    }
    result.ms    = read_intervals_ms(gpu, timestamps)[0];
    result.light = download_as<glm::vec3>(gpu, light, rays.size());
    result.next  = download_as<NextRay>(gpu, next, rays.size());
    return result;
}

} // namespace ssrlab
