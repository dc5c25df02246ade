// glTF animations against closed forms, and what is refused.
#include "scene/sequence.h"
#include "scene_files.h"

namespace ssrlab {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

/// A triangle on node 0 that one channel moves.
struct AnimatedFile : GltfFile {
    AnimatedFile() : GltfFile(GltfFile::triangle()) {}

    json& add_channel(int node, const char* path, const std::vector<float>& times_s, const std::vector<float>& values,
                      const char* interpolation = "LINEAR")
    {
        const bool rotation = std::string(path) == "rotation";
        const int  input    = add_accessor(times_s, "SCALAR", 1);
        const int  output   = add_accessor(values, rotation ? "VEC4" : "VEC3", rotation ? 4 : 3);
        if (!root.contains("animations"))
            root["animations"] = {{{"samplers", json::array()}, {"channels", json::array()}}};
        json& animation = root["animations"][0];
        animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
        return animation;
    }
};

glm::vec3 corner_in(const Scene& scene, int frame, size_t index) { return corner(scene_at(scene, frame), index); }

constexpr float eps = 1e-5F;

TEST(SceneAnimation, TranslationIsLinearBetweenKeysAndStaysAtTheLast)
{
    AnimatedFile file;
    file.add_channel(0, "translation", {0, 0.5F, 1}, {0, 0, 0, 3, 0, 0, 3, 6, 0});
    const Scene scene = file.load();
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_VEC_NEAR(corner_in(scene, 5, 0), glm::vec3(1, 0, 0), eps); // 30 frames a second: 15 to the second key
    EXPECT_VEC_NEAR(corner_in(scene, 20, 0), glm::vec3(3, 2, 0), eps);
    EXPECT_VEC_NEAR(corner_in(scene, 30, 1), glm::vec3(4, 6, 0), eps);
    EXPECT_VEC_NEAR(corner_in(scene, 500, 1), glm::vec3(4, 6, 0), eps);
    // The frame before frame 5 was 0.2 m to the left.
    const glm::dmat4 back = current_to_previous(scene.draws.at(0).motion, 5);
    EXPECT_VEC_NEAR(glm::dvec3(back[3]), glm::dvec3(-0.2, 0, 0), 1e-6);
}

TEST(SceneAnimation, KeysReplaceWhatTheNodeSays)
{
    AnimatedFile file;
    file.root["nodes"][0]["translation"] = {9, 9, 9};
    file.add_channel(0, "translation", {0.2F, 0.4F}, {1, 0, 0, 2, 0, 0});
    const Scene scene = file.load();
    EXPECT_VEC_NEAR(corner(scene, 0), glm::vec3(1, 0, 0), eps) << "before the first key: the first key";
    EXPECT_VEC_NEAR(corner_in(scene, 9, 0), glm::vec3(1.5F, 0, 0), eps);
}

TEST(SceneAnimation, StepsJumpAndCubicsFollowTheirTangents)
{
    AnimatedFile file;
    file.root["nodes"]              = {{{"mesh", 0}}, {{"mesh", 0}}};
    file.root["scenes"][0]["nodes"] = {0, 1};
    file.add_channel(0, "translation", {0, 1}, {0, 0, 0, 5, 0, 0}, "STEP");
    // p0 = 0, m0 = 4, p1 = 1, m1 = 0 over 2 s: Hermite's h00 p0 + h10 2 m0 + h01 p1 + h11 2 m1 at t = 1/4 is
    // (1/64 - 2/16 + 1/4) 8 + (3/16 - 2/64) = 9/8 + 5/32.
    file.add_channel(1, "translation", {0, 2}, {0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}, "CUBICSPLINE");
    const Scene scene = file.load();
    EXPECT_VEC_NEAR(corner_in(scene, 29, 0), glm::vec3(0, 0, 0), eps);
    EXPECT_VEC_NEAR(corner_in(scene, 30, 0), glm::vec3(5, 0, 0), eps);
    EXPECT_VEC_NEAR(corner_in(scene, 15, 3), glm::vec3(9.0F / 8 + 5.0F / 32, 0, 0), eps);
}

TEST(SceneAnimation, RotationsTakeTheShorterArcDownTheHierarchy)
{
    AnimatedFile file;
    file.root["nodes"] = {{{"children", {1}}, {"scale", {2, 2, 2}}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}};
    // From 0 to 90 degrees about y; -q is the same turn as q.
    const float half = std::numbers::sqrt2_v<float> / 2;
    file.add_channel(0, "rotation", {0, 1}, {0, 0, 0, 1, 0, -half, 0, -half});
    const Scene scene = file.load();
    EXPECT_TRUE(scene.warnings.empty()) << "a scale that does not change leaves the motion rigid";
    const double turn = 30 * std::numbers::pi / 180; // a third of the way
    EXPECT_VEC_NEAR(corner_in(scene, 10, 0), glm::vec3(2 * std::cos(turn), 0, -2 * std::sin(turn)), eps);
    EXPECT_VEC_NEAR(corner_in(scene, 30, 1), glm::vec3(0, 0, -4), eps);
    EXPECT_NEAR(glm::length(scene_at(scene, 10).vertices[0].normal_ws), 1, eps);
}

TEST(SceneAnimation, ACameraFollowsItsNode)
{
    TempFolder   folder;
    AnimatedFile file;
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "shot"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.root["nodes"]              = {{{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 5}}}};
    file.root["scenes"][0]["nodes"] = {0, 1};
    file.add_channel(1, "translation", {0, 1}, {0, 0, 5, 3, 0, 5});
    const Scene scene = load_scene(file.write(folder));
    for (const char* view : {"shot", "default"}) {
        EXPECT_VEC_NEAR(camera_at(scene, view, {10, 0}).position_ws, glm::dvec3(1, 0, 5), 1e-6) << view;
        EXPECT_VEC_NEAR(camera_at(scene, view, {99, 0}).target_ws, glm::dvec3(3, 0, 4), 1e-6) << view;
    }
    const auto motion = motion_at(scene, "default", {64, 48}, 10);
    ASSERT_TRUE(motion);
    EXPECT_TRUE(motion->camera_moves);
    // Views beside the file are what somebody chose: they win over a camera of the same name.
    folder.write("scene.gltf.views.toml", "[[view]]\nname = \"shot\"\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\n");
    EXPECT_EQ(camera_at(load_scene(folder.path().string() + "/scene.gltf"), "shot", {10, 0}).position_ws,
              glm::dvec3(0, 0, 9));
}

TEST(SceneAnimation, APartOfARecipeKeepsItsFilesMotion)
{
    TempFolder   folder;
    AnimatedFile file;
    file.add_channel(0, "translation", {0, 1}, {0, 0, 0, 3, 0, 0});
    file.write(folder, "mover.gltf");
    const std::string part  = "[[part]]\nfile = \"mover.gltf\"\nrotation_deg = [0, 90, 0]\nunit_m = 2\n";
    const std::string scene = folder.write("placed.toml", part);
    // Turned by 90 degrees, x is -z; twice as large.
    const Scene loaded = load_scene(scene);
    EXPECT_VEC_NEAR(corner_in(loaded, 10, 0) - corner(loaded, 0), glm::vec3(0, 0, -2), eps);
    EXPECT_THAT(error_of<SpecError>(folder.write("twice.toml", part + "move_m = [1, 0, 0]\n")),
                HasSubstr("its file moves by itself"));
}

TEST(SceneAnimation, WhatIsNotRigidStandsStillWithAWarning)
{
    AnimatedFile file;
    file.add_channel(0, "scale", {0, 1}, {1, 1, 1, 2, 2, 2});
    const Scene scene = file.load();
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("node 0: its animation scales")));
    EXPECT_FALSE(anything_moves(scene));
}

TEST(SceneAnimation, BrokenKeysAreRefusedWithTheirPlace)
{
    const auto refused = [](const std::vector<float>& times_s, const std::vector<float>& values,
                            const char* interpolation, auto change) {
        TempFolder   folder;
        AnimatedFile file;
        change(file.add_channel(0, "translation", times_s, values, interpolation));
        return error_of<Failure>(file.write(folder));
    };
    const auto as_it_is = [](json&) {};
    EXPECT_THAT(refused({0, 1, 1}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "LINEAR", as_it_is),
                HasSubstr("/animations/0/samplers/0/input: times must increase, got 1 s after 1 s"));
    EXPECT_THAT(refused({-1, 1}, {0, 0, 0, 1, 0, 0}, "LINEAR", as_it_is), HasSubstr("negative"));
    EXPECT_THAT(refused({0, 1}, {0, 0, 0}, "LINEAR", as_it_is), HasSubstr("expected 2 values for the times, got 1"));
    EXPECT_THAT(refused({0, 1}, {0, 0, 0, 1, 0, 0}, "CUBICSPLINE", as_it_is), HasSubstr("expected 6 values"));
    EXPECT_THAT(refused({0, 1}, {0, 0, 0, NAN, 0, 0}, "LINEAR", as_it_is), HasSubstr("not finite"));
    EXPECT_THAT(refused({0, 1e9F}, {0, 0, 0, 1, 0, 0}, "LINEAR", as_it_is), HasSubstr("at most 1200 s"));
    EXPECT_THAT(refused({0, 1}, {0, 0, 0, 1, 0, 0}, "BOUNCE", as_it_is), HasSubstr("got 'BOUNCE'"));
    EXPECT_THAT(refused({0}, {0, 0, 0}, "LINEAR", [](json& a) { a["channels"][0]["target"]["node"] = 7; }),
                HasSubstr("there is no node 7"));
    EXPECT_THAT(refused({0}, {0, 0, 0}, "LINEAR", [](json& a) { a["channels"][0]["sampler"] = 4; }),
                HasSubstr("there is no sampler 4"));
    EXPECT_THAT(refused({0}, {0, 0, 0}, "LINEAR", [](json& a) { a["channels"][0]["target"]["path"] = "colour"; }),
                HasSubstr("got 'colour'"));
    EXPECT_THAT(refused({0}, {0, 0, 0}, "LINEAR", [](json& a) { a["samplers"][0]["output"] = 99; }),
                HasSubstr("there is no accessor 99"));
}

} // namespace
} // namespace ssrlab
