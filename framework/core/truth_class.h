// What a reflected ray truly meets, pixel by pixel. How each class is decided: truth/scene_truth.h.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace ssrlab {

enum class TruthClass : uint8_t {
    not_traced    = 0,
    visible       = 1,
    hidden        = 2,
    off_screen    = 3,
    behind_camera = 4,
    facing_away   = 5,
    sky           = 6,
    beyond        = 7,
};
inline constexpr std::array<std::string_view, 8> truth_class_names = {
    "not_traced", "visible", "hidden", "off_screen", "behind_camera", "facing_away", "sky", "beyond"};

/// One entry per pixel, row-major. Undefined where not traced.
struct SceneTruth {
    glm::ivec2              size_px{0, 0};
    std::vector<TruthClass> cls;
    std::vector<glm::dvec3> point_vs;   // undefined for sky
    std::vector<glm::dvec2> point_px;   // undefined for sky and for points that are not in front of the eye
    std::vector<double>     distance_m; // along the reflected ray; +inf for sky
    std::vector<glm::vec3>  radiance;   // linear
    // Traced pixels at whose depth the scene has no surface, within self_hit_share of their distance.
    uint64_t off_surface = 0;
};

/// Returns the share of traced pixels; nullopt if none is traced.
inline std::optional<double> off_surface_share(const SceneTruth& truth)
{
    const auto rays = truth.cls.size() - size_t(std::count(truth.cls.begin(), truth.cls.end(), TruthClass::not_traced));
    return rays > 0 ? std::optional(double(truth.off_surface) / double(rays)) : std::nullopt;
}

/// Where a pixel's reflection was in the frame before. How it is decided: truth/reprojection_truth.h.
enum class ReprojectionClass : uint8_t {
    not_reflecting = 0,
    seen           = 1, // the same mirror showed the same point
    hidden         = 2, // it would have, but something was in the way
    off_screen     = 3, // it would have, outside the image
    unknown        = 4, // no answer
};

/// One entry per pixel, row-major.
struct ReprojectionTruth {
    glm::ivec2                     size_px{0, 0};
    std::vector<ReprojectionClass> cls;
    std::vector<glm::dvec2>        displacement_px; // from the pixel to there, without jitter; undefined unless seen
};

} // namespace ssrlab
