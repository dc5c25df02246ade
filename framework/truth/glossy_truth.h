// Glossy truth: what every reflecting pixel truly reflects, and the picture that follows. It shares no code with the
// shaders.
//
// From each such pixel many rays leave by the lobe of truth/ggx_lobe.h around the shading normal. A mirror has one, and
// the first rough surface that this ray meets has as many. At each further surface that reflects, one ray goes on. A
// surface sends
//   emission + (1 - albedo) * (diffuse light from below its surface) + highlights of the lights + its own reflection,
// since the rendering equation adds emission to all that is scattered (J. Kajiya 1986). Diffuse light is the radiance
// of scene_truth.h without emission and metal's share of ambient and baked light, which replaces the reflection after
// the last bounce. Lights are points, so a path takes all surfaces to be at least as rough as the roughest before (A.
// Kaplanyan, C. Dachsbacher 2013, "Path Space Regularization for Holistic and Robust Light Transport") and at least
// 0.05, as the shaders do.
// Rays follow the rules of scene_truth.h. Random numbers are a hash of pixel, ray and seed, so results repeat.
#pragma once

#include "core/image.h"
#include "truth/ggx_lobe.h"
#include "truth/scene_truth.h"

#include <optional>

namespace ssrlab {

struct GlossySettings {
    int rays    = 256; // per pixel, even
    int first   = 0; // number of the first ray, even: truths with rays 0 … n - 1, n … 2 n - 1 … of a seed combine
    int bounces = 3; // further ones
    uint32_t seed = 0;
    /// The pass composite's with reflectance = metallic: the pixel's own rays have no Fresnel factor, and the picture
    /// shows metallic ^ exponent of what they meet. Empty: reflectance = ggx.
    std::optional<float> metallic_exponent = {};
};

/// One entry per pixel, row-major; 0 if not traced.
struct GlossyTruth {
    glm::ivec2             size_px{0, 0};
    std::vector<uint32_t>  rays;     // traced rays: 0, 1 (mirror) or GlossySettings::rays
    std::vector<glm::vec3> radiance; // linear, mean of weight * radiance; with a metallic exponent over the mean weight
    /// Half of what the means of even and odd rays differ by. Both fill the lobe evenly, each by a sequence of its own,
    /// so its square is, on average, the square of the radiance's error.
    std::vector<glm::vec3> noise;
    std::vector<glm::vec3> albedo;            // mean weight: the share of light that is reflected
    std::optional<float>   metallic_exponent; // of the settings
};

GlossyTruth empty_glossy_truth(glm::ivec2 size_px);

/// Returns the truth of every reflecting pixel. threads = 0: all cores. Throws Failure for an odd number of rays.
GlossyTruth glossy_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                         const TraceSettings& settings, const GlossySettings& glossy, unsigned threads = 0);

/// Returns the G-buffer's own light with the true reflections; linear, channels R, G, B. With a metallic exponent it is
///   own + highlight + (reflected - (own - emission) - highlight) * metallic ^ exponent,
/// after C = C_frag + (C_reflect - C_frag) * metallicness ^ exponent of J. Somerville Roberts, "Screen Space
/// Reflections", II.C; what rays meet stays as it is. `noises`: 1 for the picture by the even rays alone, -1 by the odd
/// ones.
Image true_picture(const GlossyTruth& truth, const GBufferImage& gbuffer, glm::vec3 ambient, float noises = 0);

} // namespace ssrlab
