// The walk through the scene's triangles on the device against Embree's answers.
#include "world/world.h"
#include "gpu/device.h"
#include "scene/scene.h"
#include "truth/scene_bvh.h"
#include "unit/truth_scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace ssrlab::test {
namespace {

constexpr float far_m = 1e4F;

/// From anywhere in the scene's bounds, each fourth from outside, in any direction.
std::vector<WorldRay> random_rays(const Scene& scene, size_t count)
{
    glm::vec3 low(1e30F), high(-1e30F);
    for (const Vertex& vertex : scene.vertices) {
        low  = glm::min(low, vertex.position_ws);
        high = glm::max(high, vertex.position_ws);
    }
    std::mt19937                          random(7);
    std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
    std::vector<WorldRay>                 rays;
    while (rays.size() < count) {
        const glm::vec3 direction(both(random), both(random), both(random));
        const float     reach = rays.size() % 4 == 0 ? 2 : 1;
        const glm::vec3 at =
            (low + high) / 2.0F + reach * (high - low) / 2.0F * glm::vec3(both(random), both(random), both(random));
        if (glm::length(direction) > 0.1F) rays.push_back({at, 1e-3F, glm::normalize(direction), far_m});
    }
    return rays;
}

/// How a device's answer may differ from Embree's.
struct Differences {
    size_t same = 0, other_triangle = 0, nearer_edge = 0, wrong = 0;
};

/// By how much, as a share, the nearest edge of the met triangle passes the ray.
double edge_distance(glm::dvec2 barycentric)
{
    return std::min({barycentric.x, barycentric.y, 1 - barycentric.x - barycentric.y});
}

Differences compare_with_embree(const Scene& scene, const std::vector<WorldRay>& rays)
{
    const WorldPtr        world = upload_world(device(), scene);
    const WorldTrace      found = trace_world(device(), *world, rays);
    const SceneBvh        embree(scene);
    std::vector<SceneRay> scene_rays;
    for (const WorldRay& ray : rays) scene_rays.push_back({ray.origin_ws, ray.direction_ws, ray.t_min, ray.t_max});
    std::vector<SceneHit> hits(rays.size());
    embree.intersect(scene_rays, hits);
    EXPECT_GT(found.node_visits, rays.size());
    Differences differences;
    for (size_t i = 0; i < rays.size(); ++i) {
        const WorldHit& own = found.hits[i];
        EXPECT_NE(own.triangle, walk_unfinished);
        const bool         met      = own.triangle != no_triangle;
        const double       t        = met ? double(own.t) : double(far_m);
        const double       true_t   = hits[i].met ? hits[i].t : double(far_m);
        const TreeTriangle triangle = met ? world->tree.triangles[own.triangle] : TreeTriangle{};
        const bool         same_triangle =
            met && hits[i].met && triangle.draw == hits[i].surface.draw &&
            triangle.first_index == scene.draws[triangle.draw].first_index + 3 * hits[i].surface.triangle;
        const bool same_place = std::abs(t - true_t) <= 1e-4 * true_t + 1e-4;
        // A ray that passes an edge as closely as float resolves, in either's view.
        const double edge = std::min(met ? edge_distance(own.barycentric) : 1.0,
                                     hits[i].met ? edge_distance(hits[i].surface.barycentric) : 1.0);
        if ((met == hits[i].met && !met) || (same_triangle && same_place))
            ++differences.same;
        else if (same_place)
            ++differences.other_triangle; // two in one place
        else if (edge < 1e-3)
            ++differences.nearer_edge;
        else {
            ++differences.wrong;
            ADD_FAILURE() << "ray " << i << ": t " << t << " on triangle " << own.triangle << ", Embree " << true_t
                          << " edge " << edge;
        }
        if (differences.wrong > 5) return differences;
    }
    return differences;
}

// Two triangles in one place, and edges that rounding decides: a few per million. Everything else is the same triangle
// at the same place.
TEST(World, MeetsWhatEmbreeMeets)
{
    for (const char* name : {"builtin:corridor", "builtin:sphere_over_mirror", "builtin:everything"}) {
        SCOPED_TRACE(name);
        const Scene       scene       = load_scene(name);
        const Differences differences = compare_with_embree(scene, random_rays(scene, 200000));
        EXPECT_EQ(differences.wrong, 0U);
        EXPECT_LE(differences.nearer_edge, 20U);
        EXPECT_GT(differences.same, 190000U);
    }
}

// A tree of one leaf has a child that holds nothing.
TEST(World, OfTwoTrianglesIsWalkedToItsEnd)
{
    Scene scene;
    add_quad(scene, add_material(scene, {1, 1, 1}, 1), {-1, 0, -1}, {2, 0, 0}, {0, 0, 2});
    std::vector<WorldRay> rays;
    for (const float x : {-1.0F, 1.0F})
        for (const float y : {-1.0F, 1.0F})
            for (const float z : {-1.0F, 1.0F})
                rays.push_back({{0.1F, 2 * y, 0.2F}, 0, {0.1F * x, -y, 0.1F * z}, far_m});
    const size_t meeting = rays.size();
    for (size_t i = 0; i < meeting; ++i)
        rays.push_back({rays[i].origin_ws, 0, -rays[i].direction_ws, far_m}); // away from it
    const WorldTrace trace = trace_world(device(), *upload_world(device(), scene), rays);
    for (size_t i = 0; i < meeting; ++i) {
        ASSERT_LT(trace.hits[i].triangle, 2U) << i;
        EXPECT_NEAR(trace.hits[i].t, 2, 1e-5);
        EXPECT_EQ(trace.hits[meeting + i].triangle, no_triangle) << i;
    }
}

} // namespace
} // namespace ssrlab::test
