// Poses, camera paths and jitter against closed forms.
#include "scene/sequence.h"

#include "core/error.h"
#include "scene_files.h"

namespace ssrlab {
namespace {

void expect_near(glm::dvec3 got, glm::dvec3 expected, double tolerance)
{
    for (int c : {0, 1, 2}) EXPECT_NEAR(got[c], expected[c], tolerance) << "coordinate " << c;
}

TEST(Sequence, APoseTurnsAboutThePivotAndThenMoves)
{
    const RigidMotion motion{.move_m = {0.5, 0, 0}, .turn_deg = {0, 30, 0}, .pivot_ws = {2, 0, -7}};
    // 90 degrees about y take +x to -z; three moves of half a metre.
    expect_near(glm::dvec3(pose(motion, 3) * glm::dvec4(3, 1, -7, 1)), {3.5, 1, -8}, 1e-12);
    const glm::dmat4 back = current_to_previous(motion, 3);
    expect_near(glm::dvec3(back * pose(motion, 3) * glm::dvec4(3, 1, -7, 1)),
                glm::dvec3(pose(motion, 2) * glm::dvec4(3, 1, -7, 1)), 1e-12);
    EXPECT_EQ(current_to_previous(motion, 0), glm::dmat4(1)) << "frame 0 has no frame before it";
    EXPECT_EQ(current_to_previous(RigidMotion{}, 9), glm::dmat4(1)) << "what is still is so to the last bit";
}

TEST(Sequence, OnlyWhatMovesChanges)
{
    const Scene first = load_scene("builtin:moving_boxes");
    ASSERT_TRUE(anything_moves(first));
    const Scene later = scene_at(first, 10);
    int         moved = 0;
    for (size_t d = 0; d < first.draws.size(); ++d) {
        const Draw &     before = first.draws[d], &after = later.draws[d];
        const glm::dmat4 matrix = pose(before.motion, 10);
        const bool       still  = before.motion == RigidMotion{.pivot_ws = before.motion.pivot_ws};
        moved += still ? 0 : 1;
        for (uint32_t i = before.first_index; i < before.first_index + before.index_count; ++i) {
            const Vertex &a = first.vertices[first.indices[i]], &b = later.vertices[later.indices[i]];
            if (still) {
                ASSERT_EQ(a.position_ws, b.position_ws) << before.name;
                continue;
            }
            expect_near(b.position_ws, glm::dvec3(matrix * glm::dvec4(a.position_ws, 1)), 1e-6);
            EXPECT_NEAR(glm::length(b.normal_ws), 1, 1e-6);
        }
        if (before.name == "sliding box") {
            EXPECT_NEAR(after.bounds_min_ws.x - before.bounds_min_ws.x, 1, 1e-6);
        }
    }
    EXPECT_EQ(moved, 2);
    EXPECT_FALSE(anything_moves(load_scene("builtin:stairs")));
}

TEST(Sequence, APathPassesThroughItsViewsAndStaysAtTheLast)
{
    const Scene scene = load_scene("builtin:moving_boxes");
    const auto  z_of  = [&](int frame) { return camera_at(scene, "dolly", {frame, 0}).position_ws.z; };
    EXPECT_EQ(z_of(0), 3);
    EXPECT_NEAR(z_of(10), 2, 1e-12); // 3 m in 30 frames
    EXPECT_EQ(z_of(30), 0);
    EXPECT_EQ(z_of(99), 0);
    EXPECT_EQ(camera_at(scene, "orbit", {30, 0}).position_ws.z, 0.5) << "the second of three views";
    EXPECT_EQ(camera_at(scene, "default", {7, 0}).position_ws, find_camera(scene, "default").position_ws);
    EXPECT_THROW(camera_at(scene, "nowhere", {0, 0}), SpecError);
}

TEST(Sequence, MotionOverSeveralFramesIsTheirProduct)
{
    const Scene scene = load_scene("builtin:moving_boxes");
    const auto  three = motion_at(scene, "truck", {64, 36}, 7, 3).value();
    EXPECT_EQ(three.previous_view.world_to_view, motion_at(scene, "truck", {64, 36}, 5)->previous_view.world_to_view);
    for (size_t d = 0; d < scene.draws.size(); ++d) {
        const RigidMotion& motion = scene.draws[d].motion;
        const glm::dvec4   point(3, 1, -7, 1);
        const glm::dmat4   steps =
            current_to_previous(motion, 5) * current_to_previous(motion, 6) * current_to_previous(motion, 7);
        expect_near(glm::dvec3(three.to_previous_ws[d] * point), glm::dvec3(steps * point), 1e-12);
    }
    EXPECT_FALSE(motion_at(scene, "truck", {64, 36}, 2, 3)) << "nothing comes before frame 0";
}

// a to b in four frames, then c at once, then to d.
TEST(Sequence, ACutJumps)
{
    TempFolder folder;
    const auto recipe = [&](const std::string& cuts) {
        std::string text = "[[part]]\nshape = \"box\"\n";
        for (const char* view : {"a", "b", "c", "d"})
            text += fmt::format("[[view]]\nname = \"{}\"\nposition = [{}, 1, 5]\ntarget = [0, 0, 0]\n", view,
                                8 * (view[0] - 'a'));
        return folder.write("cut.toml", text +
                                            "[[path]]\nname = \"shot\"\nviews = [\"a\", \"b\", \"c\", "
                                            "\"d\"]\nframes_per_view = 4\ncuts = [\"" +
                                            cuts + "\"]\n");
    };
    const Scene         scene = load_scene(recipe("c"));
    const auto          x_of  = [&](int frame) { return camera_at(scene, "shot", {frame, 0}).position_ws.x; };
    std::vector<double> x;
    for (int frame = 0; frame < 11; ++frame) x.push_back(x_of(frame));
    EXPECT_EQ(x, (std::vector<double>{0, 2, 4, 6, 8, 16, 18, 20, 22, 24, 24}));
    for (int frame = 1; frame < 11; ++frame)
        EXPECT_EQ(motion_at(scene, "shot", {64, 36}, frame).has_value(), frame != 5);
    EXPECT_FALSE(motion_at(scene, "shot", {64, 36}, 7, 3)) << "from frame 4 to 7 there is a cut";
    EXPECT_TRUE(motion_at(scene, "shot", {64, 36}, 7, 2));
    for (const char* wrong : {"a", "e"}) EXPECT_THROW(load_scene(recipe(wrong)), SpecError);
}

TEST(Sequence, JitterRepeatsAndCoversThePixel)
{
    // Halton to the base 2 is 1/2 1/4 3/4 1/8, to the base 3 is 1/3 2/3 1/9 4/9.
    EXPECT_EQ(jitter_px({5, 0}), glm::dvec2(0));
    expect_near(glm::dvec3(jitter_px({0, 16}), 0), {0, 1.0 / 3 - 0.5, 0}, 1e-15);
    expect_near(glm::dvec3(jitter_px({3, 16}), 0), {0.125 - 0.5, 4.0 / 9 - 0.5, 0}, 1e-15);
    std::set<std::pair<double, double>> seen;
    glm::dvec2                          sum(0);
    for (int frame = 0; frame < 16; ++frame) {
        const glm::dvec2 at = jitter_px({frame, 16});
        EXPECT_LE(std::max(std::abs(at.x), std::abs(at.y)), 0.5);
        EXPECT_EQ(at, jitter_px({frame + 32, 16}));
        seen.emplace(at.x, at.y);
        sum += at;
    }
    EXPECT_EQ(seen.size(), 16U);
    EXPECT_LT(glm::length(sum) / 16, 0.1) << "the mean is near the pixel's centre";
}

TEST(Sequence, RecipesMovePartsAndCameras)
{
    TempFolder        folder;
    const std::string recipe = folder.write("moving.toml", R"(
[[part]]
shape = "box"
position = [1, 0, 0]
turn_deg = [0, 90, 0]
move_m = [0, 0.25, 0]
[[view]]
name = "a"
position = [0, 1, 5]
target = [0, 0, 0]
[[view]]
name = "b"
position = [4, 1, 5]
target = [0, 0, 0]
[[path]]
name = "ride"
views = ["a", "b"]
frames_per_view = 8
)");
    const Scene       scene  = load_scene(recipe);
    EXPECT_EQ(scene.draws.at(0).motion.pivot_ws, glm::dvec3(1, 0, 0)) << "a part turns about its position";
    const Draw later = scene_at(scene, 1).draws.at(0);
    EXPECT_NEAR(later.bounds_min_ws.x, 0.5, 1e-6);
    EXPECT_NEAR(later.bounds_min_ws.y, 0.25, 1e-6);
    EXPECT_EQ(camera_at(scene, "ride", {2, 0}).position_ws, glm::dvec3(1, 1, 5));
}

// Tait-Bryan: about x, then y, then z. Quarter turns take axes to axes, and in another order to others.
TEST(Sequence, TurnsAreAboutXThenYThenZ)
{
    const auto turned = [](glm::dvec3 turn_deg, glm::dvec3 point) {
        return glm::dvec3(pose({.turn_deg = turn_deg}, 1) * glm::dvec4(point, 1));
    };
    expect_near(turned({90, 0, 0}, {0, 1, 0}), {0, 0, 1}, 1e-12);
    expect_near(turned({0, 0, 90}, {1, 0, 0}), {0, 1, 0}, 1e-12);
    expect_near(turned({90, 0, 90}, {0, 1, 0}), {0, 0, 1}, 1e-12);
    expect_near(turned({90, 0, 90}, {0, 0, 1}), {1, 0, 0}, 1e-12);
    expect_near(turned({0, 90, 90}, {1, 0, 0}), {0, 0, -1}, 1e-12);
    expect_near(turned({90, 90, 0}, {0, 1, 0}), {1, 0, 0}, 1e-12);
    expect_near(turned({90, 90, 0}, {1, 0, 0}), {0, 0, -1}, 1e-12);
}

TEST(Sequence, APathChangesAllOfACamera)
{
    Camera a, b;
    a.name = "a", b.name = "b";
    a.position_ws = {0, 0, 0}, b.position_ws = {8, 4, 2};
    a.target_ws = {0, 0, -1}, b.target_ws = {8, 4, -7};
    a.up_ws = {0, 1, 0}, b.up_ws = {1, 0, 0};
    a.fov_y_deg = 30, b.fov_y_deg = 90;
    a.height_m = 2, b.height_m = 6;
    a.shift_px = {0, 4}, b.shift_px = {8, 0};
    Scene scene;
    scene.cameras = {a, b};
    scene.paths   = {{"shot", {a, b}, 4}};
    Camera at     = camera_at(scene, "shot", {1, 0});
    EXPECT_EQ(at.name, "shot");
    expect_near(at.position_ws, {2, 1, 0.5}, 1e-12);
    expect_near(at.target_ws, {2, 1, -2.5}, 1e-12);
    expect_near(at.up_ws, {0.25, 0.75, 0}, 1e-12);
    EXPECT_NEAR(at.fov_y_deg, 45, 1e-12);
    EXPECT_NEAR(at.height_m, 3, 1e-12);
    EXPECT_EQ(at.shift_px, glm::dvec2(2, 3));
    EXPECT_EQ(camera_at(scene, "shot", {1, 8}).shift_px, glm::dvec2(2, 3) + jitter_px({1, 8}));

    const auto moves = [&](auto change) {
        Scene changed            = scene;
        changed.paths[0].cameras = {a, a};
        change(changed.paths[0].cameras[1]);
        return motion_at(changed, "shot", {64, 36}, 1)->camera_moves;
    };
    EXPECT_FALSE(moves([](Camera&) {}));
    EXPECT_TRUE(moves([](Camera& camera) { camera.position_ws.x = camera.target_ws.x = 1; }));
    EXPECT_TRUE(moves([](Camera& camera) { camera.fov_y_deg = 31; }));
    EXPECT_TRUE(moves([](Camera& camera) { camera.shift_px.x = 1; }));
    EXPECT_TRUE(moves([](Camera& camera) { camera.up_ws = {1, 0, 0}; }));
}

TEST(Sequence, WhatTurnsTakesItsNormalsAndTangentsAlong)
{
    TempFolder folder;
    // By 90 degrees about y: x becomes -z, and z becomes x.
    const Scene scene = load_scene(folder.write(
        "turning.toml", "[[part]]\nshape = \"box\"\nsize_m = [1, 2, 3]\nripple_m = 1\nturn_deg = [0, 90, 0]\n"));
    const Scene later = scene_at(scene, 1);
    ASSERT_EQ(scene.vertices.size(), later.vertices.size());
    const auto turned = [](glm::vec3 v) { return glm::vec3(v.z, v.y, -v.x); };
    for (size_t i = 0; i < scene.vertices.size(); ++i) {
        const Vertex &before = scene.vertices[i], &after = later.vertices[i];
        ASSERT_NEAR(glm::length(glm::vec3(before.tangent_ws)), 1, 1e-5);
        EXPECT_VEC_NEAR(after.position_ws, turned(before.position_ws), 1e-5F);
        EXPECT_VEC_NEAR(after.normal_ws, turned(before.normal_ws), 1e-5F);
        EXPECT_VEC_NEAR(glm::vec3(after.tangent_ws), turned(glm::vec3(before.tangent_ws)), 1e-5F);
        EXPECT_EQ(after.tangent_ws.w, before.tangent_ws.w);
    }
    EXPECT_VEC_NEAR(later.draws.at(0).bounds_max_ws, glm::vec3(1.5F, 2, 0.5F), 1e-5F);
    EXPECT_VEC_NEAR(later.draws.at(0).bounds_min_ws, glm::vec3(-1.5F, 0, -0.5F), 1e-5F);
}

} // namespace
} // namespace ssrlab
