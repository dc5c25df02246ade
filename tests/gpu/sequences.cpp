// Frames of a sequence on the device.
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "scene/sequence.h"

namespace ssrlab::test {
namespace {

Image shaded(const GpuScenePtr& scene, const View& view)
{
    const FrameBuffersPtr buffers = make_frame_buffers(device(), draw_gbuffer(device(), scene, view));
    const FramePtr        frame   = prepared_frame(buffers, technique("hiz"), values_of(technique("hiz")), {});
    run_frame(device(), *frame);
    return read_shaded(device(), *frame);
}

// A frame depends on nothing before it: moved in place there and back, with shadows, it has the bits of a scene loaded there.
TEST(Sequences, AMovedSceneHasTheBitsOfAFreshOne)
{
    const Scene       first    = load_scene("builtin:moving_boxes");
    const GpuScenePtr uploaded = upload_scene(device(), first);
    const auto  view_of  = [&](int frame) { return camera_to_view(camera_at(first, "orbit", {frame, 16}), {97, 61}); };
    const Image at_start = shaded(uploaded, view_of(0));
    for (const int frame : {7, 40, 0}) {
        const Scene scene = scene_at(first, frame);
        move_scene(device(), *uploaded, scene);
        const Image moved = shaded(uploaded, view_of(frame));
        EXPECT_EQ(moved.values, shaded(upload_scene(device(), scene), view_of(frame)).values) << "frame " << frame;
        EXPECT_EQ(moved.values == at_start.values, frame == 0);
    }
}

/// A G-buffer of a path's frame with its motion.
GBufferImage moved_gbuffer(const Scene& first, const std::string& view, SequenceFrame at, glm::ivec2 size_px)
{
    const Scene scene = scene_at(first, at.frame);
    return read_gbuffer(
        device(), *gbuffer_of(*draw_gbuffer(device(), upload_scene(device(), scene), view_at(scene, view, size_px, at),
                                            motion_at(scene, view, size_px, at.frame))));
}

/// The largest difference from a closed form, which says where the pixel's surface was: from slope (x right, y up), distance and
/// object to the slope in the frame before.
using PreviousSlope = std::function<glm::dvec2(glm::dvec2 slope, double distance_m, const Draw* draw)>;
double largest_difference_px(const Scene& scene, const GBufferImage& image, const PreviousSlope& previous_slope)
{
    const View& view  = image.view;
    double      worst = 0;
    for (const auto [i, x, y] : pixels_of(view.size_px)) {
        const glm::dvec2 slope = (glm::dvec2(x + 0.5, y + 0.5) - view.centre_px) / view.focal_px * glm::dvec2(1, -1);
        const Draw*      draw  = image.object_id[i] == 0 ? nullptr : &scene.draws[image.object_id[i] - 1];
        const double     distance_m =
            draw == nullptr ? std::numeric_limits<double>::infinity() : view.near_m / double(image.depth[i]);
        // Without jitter slopes are differences in pixels but for the focal length.
        const glm::dvec2 moved = (previous_slope(slope, distance_m, draw) - slope) * view.focal_px * glm::dvec2(1, -1);
        worst                  = std::max(worst, glm::length(glm::dvec2(image.motion_px[i]) - moved));
    }
    return worst;
}

constexpr glm::ivec2 size_px{161, 91};
// Vectors are floats of up to 161 pixels, made of depths that are floats: some 1e-7 of that, enlarged by the divisions.
constexpr double rounding_px = 1e-3;

// A camera that moved by s to the right saw everything f s / distance farther to the right.
TEST(MotionVectors, ACameraThatMovesSideways)
{
    Scene scene = load_scene("builtin:moving_boxes");
    for (Draw& draw : scene.draws) draw.motion = {};
    for (const int phases : {0, 16}) {
        const GBufferImage image = moved_gbuffer(scene, "truck", {5, phases}, size_px);
        EXPECT_LT(largest_difference_px(scene, image,
                                        [](glm::dvec2 slope, double distance_m, const Draw*) {
                                            return slope + glm::dvec2(0.1 / distance_m, 0); // 3 m in 30 frames
                                        }),
                  rounding_px)
            << phases << " phases of jitter: vectors are without it";
    }
}

// A level camera that turned by `turn` to the right: the direction (sx, sy, -1) was seen as (sx cos + sin, sy, sx sin - cos), at any
// distance, the sky's as well.
TEST(MotionVectors, ACameraThatTurns)
{
    constexpr double turn  = 0.05;
    Scene            scene = load_scene("builtin:moving_boxes");
    for (Draw& draw : scene.draws) draw.motion = {};
    Camera ahead, aside;
    ahead.position_ws = aside.position_ws = {0, 0, 0};
    ahead.target_ws                       = {0, 0, -1};
    aside.target_ws                       = {std::sin(turn), 0, -std::cos(turn)};
    ahead.fov_y_deg = aside.fov_y_deg = 90;
    scene.paths                       = {{"turn", {ahead, aside}, 1}};
    const GBufferImage image          = moved_gbuffer(scene, "turn", {1, 0}, size_px);
    EXPECT_TRUE(std::ranges::count(image.object_id, 0U) > 0) << "there is sky";
    EXPECT_LT(largest_difference_px(scene, image,
                                    [](glm::dvec2 slope, double, const Draw*) {
                                        const double forward = std::cos(turn) - slope.x * std::sin(turn);
                                        return glm::dvec2(slope.x * std::cos(turn) + std::sin(turn), slope.y) / forward;
                                    }),
              rounding_px);
}

// The level camera stands at the origin and is still, so a point is (sx, sy, -1) distance. One box was 0.1 m farther left; the other
// was turned by 3 degrees less about the vertical axis through (2, 0, -7.5).
TEST(MotionVectors, ObjectsThatMove)
{
    const Scene                scene = load_scene("builtin:moving_boxes");
    const GBufferImage         image = moved_gbuffer(scene, "default", {4, 0}, size_px);
    std::map<std::string, int> pixels;
    EXPECT_LT(largest_difference_px(scene, image,
                                    [&](glm::dvec2 slope, double distance_m, const Draw* draw) {
                                        if (draw == nullptr) return slope;
                                        ++pixels[draw->name];
                                        const glm::dvec3 point = glm::dvec3(slope, -1) * distance_m;
                                        if (draw->name == "sliding box")
                                            return glm::dvec2(point.x - 0.1, point.y) / distance_m;
                                        if (draw->name != "turning box") return slope;
                                        constexpr double turn = 3 * std::numbers::pi / 180;
                                        const double     x = point.x - 2, z = point.z + 7.5;
                                        const double     before_x = x * std::cos(turn) - z * std::sin(turn) + 2;
                                        const double     before_z = x * std::sin(turn) + z * std::cos(turn) - 7.5;
                                        return glm::dvec2(before_x, point.y) / -before_z;
                                    }),
              rounding_px);
    // A front of 1 m at 5.5 m covers (45.5 px / 5.5)^2 = 68 pixels, one of 2 m at 6.5 m more.
    EXPECT_GT(pixels["sliding box"], 60);
    EXPECT_GT(pixels["turning box"], 60);
}

TEST(MotionVectors, AreDrawnOnlyWhereSomethingMoves)
{
    const Scene scene  = load_scene("builtin:stairs");
    const auto  motion = motion_at(scene, "default", size_px, 3);
    ASSERT_TRUE(motion);
    const GpuScenePtr uploaded   = upload_scene(device(), scene);
    const auto        plan_facts = [&](const std::optional<FrameMotion>& moved, SequenceFrame at) {
        const DrawingPtr drawing = draw_gbuffer(device(), uploaded, view_at(scene, "default", size_px, at), moved);
        EXPECT_TRUE(read_gbuffer(device(), *gbuffer_of(*drawing)).motion_px.empty());
        return describe_facts(plan_of(*prepared_frame(make_frame_buffers(device(), drawing), technique("hiz"),
                                                             values_of(technique("hiz")), {})))
            .back();
    };
    EXPECT_THAT(plan_facts({}, {}), ::testing::HasSubstr("no frame before this one"));
    EXPECT_THAT(plan_facts(motion, {3, 0}), ::testing::HasSubstr("still camera, 0 of 10 objects move, no jitter"));
    EXPECT_THAT(plan_facts(motion, {3, 16}), ::testing::HasSubstr("with jitter"));
    EXPECT_FALSE(motion_at(scene, "default", size_px, 0)) << "nothing comes before frame 0";
}

} // namespace
} // namespace ssrlab::test
