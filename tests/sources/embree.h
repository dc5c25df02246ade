// The device's walk through a scene's triangles against Embree's, ray by ray; each difference is put down to its cause.
#pragma once

#include "test.h"
#include "truth/scene_bvh.h"
#include "world/world.h"

namespace ssrlab::test {

inline constexpr float far_m = 1e4F;

/// Why two answers differ; the first that applies. All but `wrong` are within the rounding of single precision.
enum class Cause : uint8_t {
    none,         // the same triangle at the same distance, or both meet nothing
    in_one_place, // two triangles at the same distance: one upon the other, or at their common edge
    edge,         // the ray passes the edge of the nearer triangle
    edge_on,      // the ray runs along the nearer triangle
    limit,        // the nearer triangle lies where the ray begins or ends
    mask,         // the alpha of the nearer triangle is that of its mask
    wrong,
};
inline constexpr std::array<const char*, 7> cause_names = {"none",       "in one place", "edge", "edge-on",
                                                           "at a limit", "at a mask",    "wrong"};

struct Differences {
    size_t                rays = 0, meeting = 0;
    std::array<size_t, 7> by_cause{};
    std::string           first_wrong;

    size_t of(Cause cause) const { return by_cause[static_cast<size_t>(cause)]; }
};

/// Adds to `differences`.
void compare_with_embree(const SceneBvh& embree, const World& world, std::span<const WorldRay> rays,
                         Differences& differences);

/// From anywhere in the scene's bounds, each fourth from outside: in any direction, and each third toward a point on an
/// edge or toward a corner of a triangle.
std::vector<WorldRay> random_rays(const Scene& scene, size_t count, uint32_t seed);

} // namespace ssrlab::test
