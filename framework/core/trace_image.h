// What each ray found and why it stopped.
#pragma once

#include "core/pixel_index.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

/// Why a ray stopped. The values are shared with shaders/layout/shared.h.
enum class TraceStatus : uint8_t {
    not_traced        = 0, // background, not reflective, or without a usable normal
    hit               = 1,
    left_screen       = 2, // crossed the image border or the near plane
    past_max_distance = 3, // reached the maximum distance (or infinity) inside the image
    out_of_steps      = 4, // gave up; never a hit
    facing_away       = 5, // would be a miss, and met something from behind (behind = pass)
    stopped           = 6, // no hit: met something from a side that this frame does not show (behind = stop)
    impossible        = 7, // not an answer: an unknown status, or a hit off the image (compare/validate_result.h)
};
/// Whether a ray with this status has a pixel and a point.
inline bool has_place(TraceStatus status) { return status == TraceStatus::hit || status == TraceStatus::stopped; }
/// Names of the valid statuses.
inline constexpr std::array<std::string_view, 7> trace_status_names = {
    "not_traced", "hit", "left_screen", "past_max_distance", "out_of_steps", "facing_away", "stopped"};
inline std::string_view status_name(TraceStatus status)
{
    const auto number = static_cast<size_t>(status);
    return number < trace_status_names.size() ? trace_status_names[number] : "impossible";
}

/// How often each ray read a structure. Work that building did for a whole group of rays counts for its first ray.
struct StructureFetches {
    std::string           structure;
    std::vector<uint32_t> fetches;

    bool operator==(const StructureFetches&) const = default;
};

/// One entry per pixel of the image, row-major. The ray of pixel (x, y) is its mirror reflection.
struct TraceImage {
    glm::ivec2               size_px{0, 0};
    std::vector<TraceStatus> status;
    std::vector<glm::ivec2>  hit_pixel;    // the pixel that was met; undefined unless hit or stopped
    std::vector<uint8_t>     hit_layer;    // the layer of that pixel; 0: the first
    std::vector<glm::dvec3>  hit_px_depth; // x, y in pixels, depth; on the ray, inside hit_pixel; undefined likewise
    std::vector<double>
        hit_t; // 0 at the reflecting pixel, 1 at the end of the clipped screen segment; undefined likewise
    std::vector<uint32_t>         steps;             // loop iterations; 0 where not traced
    std::vector<uint32_t>         depth_fetches;     // empty when the result was not counted
    std::vector<StructureFetches> structure_fetches; // of each structure that the technique reads
    std::vector<size_t>           traced_order = {}; // indices of the pixels as their rays were traced; empty: unknown
};

/// Returns a result in which no pixel is traced, with fetch counts if `counted`.
inline TraceImage make_trace_image(glm::ivec2 size_px, bool counted)
{
    const auto count = pixel_count(size_px);
    TraceImage result;
    result.size_px = size_px;
    result.status.assign(count, TraceStatus::not_traced);
    result.hit_pixel.resize(count);
    result.hit_layer.resize(count);
    result.hit_px_depth.resize(count);
    result.hit_t.resize(count);
    result.steps.resize(count);
    if (counted) {
        result.depth_fetches.resize(count);
    }
    return result;
}

/// Returns the reads of all structures by one ray.
inline uint32_t structure_fetches_of(const TraceImage& result, size_t pixel)
{
    uint32_t sum = 0;
    for (const StructureFetches& of : result.structure_fetches) sum += of.fetches[pixel];
    return sum;
}

/// What happens to a ray that meets a pixel from a side that the frame does not show.
enum class Behind : uint8_t { hit, pass, stop };
inline constexpr std::array<std::string_view, 3> behind_names = {"hit", "pass", "stop"};

/// The hit contract's settings: they belong to the experiment, never to a technique. The defaults are those that
/// measure best (docs/explanation/effects.md).
struct TraceSettings {
    double      thickness_m        = 0.1;   // the slab of a pixel reaches from its distance to distance + thickness
    bool        thickness_relative = false; // thickness is then a fraction of the distance
    double      max_distance_m     = 1e9;   // length of the ray in view space; may be +inf
    double      ray_offset_m       = 0;     // the ray starts this many metres along its direction
    Behind      behind             = Behind::stop;
    std::string surface = "plane_solid"; // id of the surface model: what a pixel holds around its depth sample
    int         layers  = 1;             // that a pixel holds at most, the first included
    // Metals reflect, and other materials of at least this reflectance at normal incidence and at most this roughness.
    double dielectric_min_f0        = 0.02;
    double dielectric_max_roughness = 0.4;

    /// Whether a surface of this material reflects; the shaders compare the same floats (shaders/rays/reflecting.glsl).
    bool material_reflects(float metallic, float dielectric_f0, float roughness) const
    {
        return metallic > 0 ||
               (dielectric_f0 >= float(dielectric_min_f0) && roughness <= float(dielectric_max_roughness));
    }

    bool operator==(const TraceSettings&) const = default;
};

/// Returns `settings` with the simplest surface, whose answers have closed forms: a box in each pixel.
inline TraceSettings boxes(TraceSettings settings = {}, Behind behind = Behind::hit)
{
    settings.surface = "box";
    settings.behind  = behind;
    return settings;
}

} // namespace ssrlab
