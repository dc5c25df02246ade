// Glossy truth: what every pixel that reflects truly reflects, and the finished picture that follows from it. Nothing of it is shared
// with the shaders that it judges.
//
// From each such pixel many rays leave through the scene, by the lobe of truth/ggx_lobe.h around the shading normal. From a mirror it is
// one, and as many leave from the first rough surface that this one meets. Where a ray meets a surface that reflects, too, it goes on
// from there in the same way, one ray for each. A surface sends back
//   emission + (1 - albedo) * (diffuse light from below its surface) + highlights of the lights + its own reflection,
// since the rendering equation adds emission to all that is scattered (J. Kajiya 1986). The diffuse light is the scene truth's radiance
// (scene_truth.h) without emission and metal's share of the ambient light, which there stands in for a metal's reflection; after the last bounce it stands in again. Lights are points, so that the highlights of a smooth surface
// have no size: a path takes all surfaces to be at least as rough as the roughest one that it came from (A. Kaplanyan, C. Dachsbacher
// 2013, "Path Space Regularization for Holistic and Robust Light Transport"), and at least of roughness 0.05, as the shaders do.
//
// Rays follow the rules of scene_truth.h. Their random numbers come from a hash of pixel, ray and seed, so the result is always the same.
#pragma once

#include "core/image.h"
#include "truth/ggx_lobe.h"
#include "truth/scene_truth.h"

namespace ssrlab {

struct GlossySettings {
    int rays = 64; // a pixel, at least 2
    int first =
        0; // ray: truths of one seed with rays 0 … n - 1, n … 2 n - 1, … fill the lobe together as evenly as one with all
    int      bounces = 3; // further ones
    uint32_t seed    = 0;
};

/// One entry per pixel, row-major; all 0 where nothing was traced.
struct GlossyTruth {
    glm::ivec2             size_px{0, 0};
    std::vector<uint32_t>  rays;     // that were traced: 0, 1 (mirror) or GlossySettings::rays
    std::vector<glm::vec3> radiance; // linear, mean of weight * radiance
    std::vector<glm::vec3>
        standard_error;            // of that mean if the rays were independent; they fill the lobe evenly and err less
    std::vector<glm::vec3> albedo; // mean weight: the share of light that is reflected
};

GlossyTruth empty_glossy_truth(glm::ivec2 size_px);

/// Returns the truth of every reflecting pixel. threads = 0: all cores.
GlossyTruth glossy_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                         const TraceSettings& settings, const GlossySettings& glossy, unsigned threads = 0);

/// Returns the G-buffer's own light with the true reflections; linear, channels R, G, B.
Image true_picture(const GlossyTruth& truth, const GBufferImage& gbuffer, glm::vec3 ambient);

} // namespace ssrlab
