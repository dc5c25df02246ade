// Light at the hits of world-space rays, by the G-buffer's own shading code.
#pragma once

#include "frame/directional_albedo.h"
#include "frame/gpu_scene.h"
#include "world/world.h"

namespace ssrlab {

/// The mirror ray that goes on where a surface reflects, to find the light that the surface reflects.
struct NextRay {
    WorldRay  ray;
    glm::vec3 weight{0}; // of the light that it finds; 0: there is no next ray
};

struct WorldLight {
    std::vector<glm::vec3> light; // linear radiance back along each ray; 0 if it met nothing
    std::vector<NextRay>   next;  // of each ray
    double                 ms = 0;
};

/// Returns the pass that computes, from each ray of a list and its hit, the light that comes back and the next ray.
ComputePass make_shade_pass(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                            const WorldRayList& list, const Buffer& hits, const Buffer& light, const Buffer& next);
/// Records that pass. `launch`: that of the list. `trace` and `follows`: see shade_world().
void record_shade(const Commands& commands, const ComputePass& pass, const GpuScene& scene, const TraceSettings& trace,
                  bool follows, const Buffer& launch);

/// Runs the pass twice and returns its output with the milliseconds of the second run. `trace` says which surfaces
/// reflect; with `follows` = false none does, and ambient light stands in for what metals reflect.
WorldLight shade_world(Gpu& gpu, const World& world, const GpuScene& scene, const SampledTable& dfg_table,
                       const TraceSettings& trace, bool follows, std::span<const WorldRay> rays,
                       std::span<const WorldHit> hits);

} // namespace ssrlab
