// The grid of occupied cells against Embree, on the host and on the device: a ray that meets a triangle never passes it
// by.
#include "gpu/device.h"
#include "truth/scene_bvh.h"
#include "unit/truth_scenes.h"
#include "world/grid_walk.h"

namespace ssrlab::test {
namespace {

TEST(Occupancy, NeverDeniesWhatARayMeets)
{
    Scene          scene;
    const uint32_t grey = add_material(scene, {0.5, 0.5, 0.5}, 0);
    add_quad(scene, grey, {-9, 0, -9}, {18, 0, 0}, {0, 0, 18});
    add_quad(scene, grey, {-3, 0.5, -4}, {1, 2, 0.3}, {0.2, 0.1, 1});
    add_sphere(scene, grey, {2, 2, -3}, 1, 20);
    for (int i = 0; i < 40; ++i) // rods in all directions
        add_quad(scene, grey, {-8 + 0.4 * i, 3, -7 + 0.3 * i}, {0.02, 0.01, 0.03}, {4 - 0.2 * i, 4, 0.1 * i - 3});
    for (const int side : {1, 7, 64}) {
        const Occupancy                        grid = make_occupancy(scene, side);
        const SceneBvh                         embree(scene);
        std::mt19937                           random(3);
        std::uniform_real_distribution<double> unit(-1, 1);
        std::vector<SceneRay>                  rays;
        std::vector<WorldRay>                  device_rays;
        for (int i = 0; i < 20000; ++i) {
            glm::dvec3 direction(unit(random), unit(random), unit(random));
            if (i % 5 == 0) direction[i / 5 % 3] = 0;
            const WorldRay ray{glm::vec3(12.0 * glm::dvec3(unit(random), unit(random), unit(random))), 0,
                               glm::vec3(glm::normalize(direction)), 1e9F, 0};
            device_rays.push_back(ray);
            rays.push_back({glm::dvec3(ray.origin_ws), glm::dvec3(ray.direction_ws), 0, ray.t_max});
        }
        std::vector<SceneHit> hits(rays.size());
        embree.intersect(rays, hits);
        const GridWalk walk   = walk_grid(device(), upload_grid(device(), grid), device_rays);
        size_t         denied = 0, missed = 0, same = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const double met_m    = first_occupied(grid, rays[i].origin_ws, rays[i].direction_ws, 0, rays[i].t_max);
            const bool   possible = std::isfinite(met_m);
            EXPECT_TRUE(!hits[i].met || std::max(met_m, double(walk.met_m[i])) <= hits[i].t + 1e-5)
                << "ray " << i << " with " << side << " cells a side";
            missed += !hits[i].met;
            denied += !hits[i].met && !possible;
            same += possible ? std::abs(walk.met_m[i] - met_m) < 1e-4 : !std::isfinite(walk.met_m[i]);
        }
        EXPECT_GT(double(denied), (side == 64 ? 0.8 : 0.1) * double(missed)); // it is of use
        EXPECT_GT(same, rays.size() * 99 / 100); // others pass a cell within rounding of its border
    }
}

TEST(Occupancy, OfNothingIsEmpty)
{
    EXPECT_FALSE(may_meet(make_occupancy(Scene{}), {0, 0, 0}, {0, 0, 1}, 0, 1e9));
    Scene flat;
    add_quad(flat, add_material(flat, {1, 1, 1}, 1), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Occupancy grid = make_occupancy(flat);
    EXPECT_TRUE(may_meet(grid, {0.5, 0.5, 5}, {0, 0, -1}, 0, 9));
    EXPECT_FALSE(may_meet(grid, {0.5, 0.5, 5}, {0, 0, -1}, 0, 4)); // ends before it
    EXPECT_FALSE(may_meet(grid, {0.5, 0.5, 5}, {0, 0, 1}, 0, 1e9));
}

} // namespace
} // namespace ssrlab::test
