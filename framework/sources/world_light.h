// Light at the hits of world-space rays, by the G-buffer's own shading code.
#pragma once

#include "frame/gpu_scene.h"
#include "world/world.h"

namespace ssrlab {

struct WorldLight {
    std::vector<glm::vec3> light; // linear radiance back along each ray; 0 if it met nothing
    double                 ms = 0;
};

WorldLight shade_world(Gpu& gpu, const World& world, const GpuScene& scene, std::span<const WorldRay> rays,
                       std::span<const WorldHit> hits);

} // namespace ssrlab
