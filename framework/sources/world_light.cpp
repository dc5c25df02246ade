#include "sources/world_light.h"

namespace ssrlab {
namespace {

/// shaders/world/shade.comp, scalar layout.
struct ShadePush {
    glm::vec3 ambient;
    uint32_t  ray_count;
    int32_t   light_count;
};

} // namespace

WorldLight shade_world(Gpu& gpu, const World& world, const GpuScene& scene, std::span<const WorldRay> rays,
                       std::span<const WorldHit> hits)
{
    WorldLight result;
    if (rays.empty() || world.tree.nodes.empty()) {
        result.light.resize(rays.size());
        return result;
    }
    const Buffer listed = make_buffer_with<WorldRay>(gpu, rays), found = make_buffer_with<WorldHit>(gpu, hits);
    const Buffer light    = make_buffer(gpu, rays.size() * sizeof(glm::vec3));
    Bindings     bindings = material_bindings(world);
    bindings.insert({{"WorldRays", listed},
                     {"WorldHits", found},
                     {"WorldLight", light},
                     {"Lights", scene.lights},
                     {"ShadowMatrices", scene.shadow_matrices},
                     {"shadow_map", {scene.shadow_map, scene.shadow_sampler}}});
    const ComputePass pass =
        make_compute_pass(gpu, compile_shader(gpu, {.file = "world/shade.comp"}), bindings, {}, sizeof(ShadePush));
    const Timestamps timestamps = make_timestamps(gpu, 2);
    for (int turn : {0, 1}) { // a driver may compile a pipeline when it first runs
        static_cast<void>(turn);
        submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
            barrier(commands);
            push(commands, pass,
                 ShadePush{scene.ambient, static_cast<uint32_t>(rays.size()), static_cast<int32_t>(scene.light_count)});
            write_timestamp(commands, timestamps, 0);
            dispatch(commands, pass, groups_for(rays.size()));
            barrier(commands);
            write_timestamp(commands, timestamps, 1);
        });
    }
    result.ms    = read_intervals_ms(gpu, timestamps)[0];
    result.light = download_as<glm::vec3>(gpu, light, rays.size());
    return result;
}

} // namespace ssrlab
