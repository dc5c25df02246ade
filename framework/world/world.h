// The scene's triangles on the device: any rays in, the first triangle that each meets out. Both sides of a triangle
// stop a ray; alpha masks are looked up at the textures' finest level.
#pragma once

#include "gpu/compute.h"
#include "world/triangle_tree.h"

#include <memory>
#include <span>

namespace ssrlab {

/// A ray from t_min to t_max along the direction, which need not be of unit length (shaders/world/rays.glsl).
struct WorldRay {
    glm::vec3 origin_ws{0};
    float     t_min = 0;
    glm::vec3 direction_ws{0};
    float     t_max     = 0; // finite
    float     roughness = 0; // of what it left: highlights are blurred by it
};

inline constexpr uint32_t no_triangle = 0xFFFFFFFFU, walk_unfinished = 0xFFFFFFFEU;

struct WorldHit {
    float     t        = 0;           // undefined unless a triangle was met
    uint32_t  triangle = no_triangle; // index into TriangleTree::triangles, or one of the two above
    glm::vec2 barycentric{0};         // weights of the second and third corner
};

struct World {
    TriangleTree tree;
    Buffer       nodes, triangles, vertices, indices, materials, textures, texels;
    uint64_t     bytes       = 0;     // of these buffers
    bool         alpha_masks = false; // some material has one
};
using WorldPtr = std::shared_ptr<const World>;

/// Builds the tree and uploads it with the scene's vertices, materials and textures. Throws Failure as
/// build_triangle_tree().
std::shared_ptr<World> upload_world(Gpu& gpu, const Scene& scene);
/// Moves its triangles and vertices to where the scene, which is the same in another frame, has them.
void move_world(Gpu& gpu, World& world, const Scene& moved);

/// The dispatch over a list, RAYS_PER_GROUP entries to a workgroup, and the list's length. Shaders that append to a
/// list keep it up to date on the device (shaders/world/append.glsl).
struct ListLaunch {
    glm::uvec3 groups{0, 0, 1};
    uint32_t   count = 0;
};

/// Rays on the device, as many as `launch` says.
struct WorldRayList {
    Buffer rays, launch;
};
WorldRayList make_ray_list(Gpu& gpu, std::span<const WorldRay> rays);
/// Makes an empty list with room for `capacity` rays.
WorldRayList make_ray_list(Gpu& gpu, size_t capacity);
/// Records that a list becomes empty.
void record_empty(const Commands& commands, const Buffer& launch);

/// Share of the distance from the eye to a ray's origin. What a ray meets nearer than this is the surface that it
/// leaves, because the origin's depth is a rounded float.
inline constexpr double world_start_share = 1e-4;

/// Returns the buffers that shaders/world/materials.glsl reads, and the triangles.
Bindings material_bindings(const World& world);

/// Returns the pass that finds the first triangle that each ray of a list meets. Dispatch it by the list's launch.
ComputePass make_walk_pass(Gpu& gpu, const World& world, const WorldRayList& list, const Buffer& hits);

struct WorldTrace {
    std::vector<WorldHit> hits;            // of each ray
    double                ms          = 0; // of the timed pipeline
    uint64_t              node_visits = 0; // of all rays
};

/// Traces the rays; they are timed in one run and counted in another.
WorldTrace trace_world(Gpu& gpu, const World& world, std::span<const WorldRay> rays);

} // namespace ssrlab
