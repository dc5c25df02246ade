// The walk through the scene's triangles on the device against Embree's answers.
#include "world/world.h"
#include "gpu/device.h"
#include "scene/sequence.h"
#include "sources/answer_rays.h"
#include "sources/embree.h"
#include "unit/truth_scenes.h"

namespace ssrlab::test {
namespace {

// Edges and corners are hit on purpose. Everything else is the same triangle at the same distance.
TEST(World, MeetsWhatEmbreeMeets)
{
    for (const char* name : {"builtin:corridor", "builtin:sphere_over_mirror", "builtin:everything"}) {
        SCOPED_TRACE(name);
        const Scene scene = load_scene(name);
        Differences differences;
        compare_with_embree(SceneBvh(scene), *upload_world(device(), scene), random_rays(scene, 60'000, 7),
                            differences);
        EXPECT_EQ(differences.of(Cause::wrong), 0U) << differences.first_wrong;
        EXPECT_GT(differences.meeting, 15'000U);
        EXPECT_GT(differences.of(Cause::none), 39'000U); // of a third, each is at an edge
    }
}

TEST(World, MeetsWhatHasMovedWhereItIs)
{
    const Scene scene = load_scene("builtin:moving_boxes");
    const auto  world = upload_world(device(), scene);
    for (const int frame : {9, 4}) {
        SCOPED_TRACE(frame);
        const Scene moved = scene_at(scene, frame);
        move_world(device(), *world, moved);
        Differences differences;
        compare_with_embree(SceneBvh(moved), *world, random_rays(moved, 30'000, 7), differences);
        EXPECT_EQ(differences.of(Cause::wrong), 0U) << differences.first_wrong;
        EXPECT_GT(differences.meeting, 5'000U);
    }
}

/// The rays that sources ask about: mirror rays of all views of a scene.
std::vector<WorldRay> mirror_rays(const std::string& name)
{
    Stage                 stage = open_stage(device(), catalogue(), load_scene(name));
    const Technique&      hiz   = technique("hiz");
    std::vector<WorldRay> rays;
    for (const Camera& camera : stage.scene.cameras) {
        show(stage, camera.name, {480, 270});
        for (const OpenRay& ray : make_source_context(stage, hiz, values_of(hiz), {}).rays)
            rays.push_back({glm::vec3(ray.origin_ws), float(1e-4 * ray.eye_m), glm::vec3(ray.direction_ws), far_m});
    }
    return rays;
}

class WorldCampaign : public testing::TestWithParam<const char*> {};

/// $SSRLAB_LONG rays in all scenes together; without it there is no campaign.
TEST_P(WorldCampaign, DiffersFromEmbreeByRoundingAlone)
{
    const char* asked = std::getenv("SSRLAB_LONG");
    if (asked == nullptr) GTEST_SKIP() << "tests/stress/run world";
    constexpr size_t scenes = 9, batch = 200'000;
    const size_t     planned = std::strtoull(asked, nullptr, 10) / scenes;
    const Scene      scene   = load_scene(GetParam());
    const SceneBvh   embree(scene);
    const WorldPtr   world = upload_world(device(), scene);
    Differences      differences;
    const auto       mirrored = mirror_rays(GetParam());
    compare_with_embree(embree, *world, std::span(mirrored).first(std::min(mirrored.size(), planned / 2)), differences);
    const size_t real = differences.rays;
    for (uint32_t seed = 1; differences.rays < planned; ++seed)
        compare_with_embree(embree, *world, random_rays(scene, std::min(batch, planned - differences.rays), seed),
                            differences);
    fmt::print("| {} | {} | {} | {} |", GetParam(), differences.rays, real, differences.meeting);
    for (const size_t count : std::span(differences.by_cause).subspan(1)) fmt::print(" {} |", count);
    fmt::print("\n");
    EXPECT_EQ(differences.of(Cause::wrong), 0U) << differences.first_wrong;
}

INSTANTIATE_TEST_SUITE_P(Scenes, WorldCampaign,
                         testing::Values("engine", "thin_yard", "interior", "teapot_bunnies", "marble_hall",
                                         "animal_on_metal", "forest_clearing", "wet_street", "ripples"),
                         [](const auto& scene) { return std::string(scene.param); });

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
