// Light at the hits of world-space rays, by the G-buffer's own shading code.
#pragma once

#include "frame/directional_albedo.h"
#include "frame/gpu_scene.h"
#include "world/world.h"

namespace ssrlab {

/// Where a surface reflects, its light is made of what it reflects, too: the next ray finds that.
struct NextRay {
    WorldRay  ray;
    glm::vec3 weight{0}; // of the light that it finds; 0: there is no next ray
};

struct WorldLight {
    std::vector<glm::vec3> light; // linear radiance back along each ray; 0 if it met nothing
    std::vector<NextRay>   next;  // of each ray
    double                 ms = 0;
};

/// The pass that makes the light and the next ray of each ray of a list and its hit.
ComputePass make_shade_pass(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                            const WorldRayList& list, const Buffer& hits, const Buffer& light, const Buffer& next);
/// `launch`: of the list.
void record_shade(const vk::raii::CommandBuffer& commands, const ComputePass& pass, const GpuScene& scene,
                  const TraceSettings& trace, bool follows, const Buffer& launch);

/// `trace`: says which surfaces reflect. `follows`: false: none does, and metal's ambient light stands in for what it
/// reflects.
WorldLight shade_world(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                       const TraceSettings& trace, bool follows, std::span<const WorldRay> rays,
                       std::span<const WorldHit> hits);

} // namespace ssrlab
