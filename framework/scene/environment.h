// Light from infinitely far away: an equirectangular map around the scene, which misses fall back on.
//
// World directions: +x right, +y up, -z forwards. The map's middle is forwards, its right half +x, its top row up:
//   u = 0.5 + atan2(x, -z) / (2 pi)    v = 0.5 - atan2(y, sqrt(x^2 + z^2)) / pi    (u = 0.5 at the poles)
// Texels are blended bilinearly, around in u, clamped in v. shaders/gbuffer/environment.glsl is the same in GLSL.
#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

inline constexpr float largest_radiance = 65504; // of half precision, which pictures are kept in

struct EnvironmentMap {
    glm::ivec2             size_px{0, 0};
    std::vector<glm::vec3> radiance; // linear, finite, row 0 on top; empty: there is no map
};

/// The direction need not be a unit vector.
glm::dvec2 direction_to_uv(glm::dvec3 direction_ws);
glm::dvec3 uv_to_direction(glm::dvec2 uv);

/// `map` must not be empty.
glm::vec3 environment_radiance(const EnvironmentMap& map, glm::dvec3 direction_ws);

/// Reads an .hdr or .exr twice as wide as high, times `scale`. Negative radiance becomes 0; values that are not finite
/// or exceed half precision are clamped and counted in `warnings`. Throws Failure with what was expected and found.
EnvironmentMap load_environment(const std::filesystem::path& file, double scale, std::vector<std::string>& warnings);

/// Radiance straight up, level, and below.
struct SkyColours {
    glm::dvec3 zenith{0.1, 0.25, 0.62}, horizon{0.62, 0.7, 0.78}, ground{0.3, 0.28, 0.26};
};

/// Makes a sky without a file: a gradient, one colour below, and optionally a sun of 4 degrees radius.
EnvironmentMap make_sky(const SkyColours& colours, std::optional<glm::dvec3> to_sun_ws = {});

} // namespace ssrlab
