// Glossy scene truth: what a rough surface reflects, by many rays a pixel.
//
// Half vectors h are drawn from the GGX distribution of normals that are visible from the viewer v (Heitz 2018, "Sampling the GGX
// Distribution of Visible Normals", JCGT 7(4)) around the shading normal, with alpha = roughness^2. A ray leaves along l, the mirror
// image of v at h, and counts with G2(v, l) / G1(v) of Smith's height-correlated masking (Heitz 2014); below the shading horizon
// with 0. So the mean is the integral of radiance * D G2 / (4 n.v): the reflection without Fresnel's factor, which belongs to the
// compositing. Below mirror_roughness it is the mirror ray alone, and the scene truth's radiance to the last bit.
// Rays follow the rules of scene_truth.h; random numbers are a hash of pixel, ray and seed, so the result is always the same.
#pragma once

#include "truth/scene_truth.h"

namespace ssrlab {

inline constexpr float mirror_roughness = 0.02F;

struct GlossySettings {
    int      rays = 64; // a pixel, at least 2
    uint32_t seed = 0;
};

/// One entry per pixel, row-major; all 0 where nothing was traced.
struct GlossyTruth {
    glm::ivec2             size_px{0, 0};
    std::vector<uint32_t>  rays;           // that were traced: 0, 1 (mirror) or GlossySettings::rays
    std::vector<glm::vec3> radiance;       // linear, mean of weight * radiance
    std::vector<glm::vec3> standard_error; // of that mean
    std::vector<float>     weight;         // mean weight; radiance / weight is the weighted mean, as a blur gives it
};

GlossyTruth empty_glossy_truth(glm::ivec2 size_px);

/// Threads = 0: all cores.
GlossyTruth glossy_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                         const TraceSettings& settings, const GlossySettings& glossy, unsigned threads = 0);

/// As a reflection at full weight; weight -1 where nothing reflects.
std::vector<glm::vec4> reflection_of(const GlossyTruth& truth);

} // namespace ssrlab
