// Where reflections were in the frame before, against closed forms.
#include "core/pixel_index.h"
#include "frame/passes/choices.h"
#include "gpu/sequence_frames.h"

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{320, 180};

/// The second frame of a sequence whose first one was kept.
struct SecondFrame {
    GBufferImage           image;
    std::vector<glm::vec2> vectors_px;
    TraceImage             hits;
};

SecondFrame second_frame(const Scene& scene, const std::string& view, const std::string& id, int jitter_phases = 0,
                         const ParameterValues& changed = {})
{
    ParameterValues passes{strategy(id)};
    passes.insert(changed.begin(), changed.end());
    const FrameHistoryPtr history = make_history(device(), size_px);
    for (const int frame : {0, 1}) {
        const SequencePicture picture = picture_at(scene, view, {frame, jitter_phases}, size_px);
        const FramePtr        run     = run_picture(picture, passes, history, "dda");
        if (frame == 1)
            return {read_gbuffer(device(), *picture.gbuffer), read_reprojection(device(), *run), counted(*run)};
        keep_history(device(), *run, frame);
    }
    return {};
}

/// Of a pixel's position without jitter: slope (x right, y up) of its view ray, and the object that its ray hit. NaN: not judged.
using ExpectedVector = std::function<glm::dvec2(glm::dvec2 slope, const Draw& hit)>;

glm::dvec2 slope_of(size_t i, const View& view)
{
    const glm::dvec2 down = (glm::dvec2(pixel_at(i, size_px)) + 0.5 - view.centre_px) / view.focal_px;
    return {down.x, -down.y};
}

struct Errors {
    size_t hits = 0, unseen = 0;
    double median_px = 0, p95_px = 0;
};

Errors errors_of(const Scene& scene, const SecondFrame& frame, const ExpectedVector& expected)
{
    Errors              errors;
    std::vector<double> errors_px;
    for (size_t i = 0; i < frame.vectors_px.size(); ++i) {
        if (frame.hits.status[i] != TraceStatus::hit) continue;
        const uint32_t   object = frame.image.object_id[pixel_index(frame.hits.hit_pixel[i], size_px)];
        const glm::dvec2 truth  = expected(slope_of(i, frame.image.view), scene.draws[object - 1]);
        if (std::isnan(truth.x)) continue;
        ++errors.hits;
        if (std::isnan(frame.vectors_px[i].x))
            ++errors.unseen;
        else
            errors_px.push_back(glm::length(glm::dvec2(frame.vectors_px[i]) - truth));
    }
    if (errors_px.empty()) return errors;
    std::ranges::sort(errors_px);
    errors.median_px = errors_px[errors_px.size() / 2];
    errors.p95_px    = errors_px[errors_px.size() * 95 / 100];
    return errors;
}

void expect_exact(const Errors& errors, size_t least_hits)
{
    EXPECT_GT(errors.hits, least_hits);
    EXPECT_LT(errors.unseen, errors.hits / 20);
    EXPECT_LT(errors.median_px, 0.1);
    EXPECT_LT(errors.p95_px, 0.5);
}

/// Both solve for the reflection in the previous plane; they differ in where they have the two points from.
constexpr const char* exact_strategies[] = {"plane", "carried_plane"};

void expect_exact_strategies(const Scene& scene, const std::string& view, const ExpectedVector& expected,
                             size_t least_hits, int jitter_phases = 0)
{
    for (const char* id : exact_strategies) {
        SCOPED_TRACE(id);
        expect_exact(errors_of(scene, second_frame(scene, view, id, jitter_phases), expected), least_hits);
    }
}

Camera level_camera(glm::dvec3 position_ws, double turn_rad = 0)
{
    Camera camera;
    camera.position_ws = position_ws;
    camera.target_ws   = position_ws + glm::dvec3(std::sin(turn_rad), 0, -std::cos(turn_rad));
    camera.fov_y_deg   = 90;
    return camera;
}

const double focal_px = size_px.y / 2.0; // at 90 degrees

// builtin:mirror_floor_wall has a mirror in y = -1 and a wall in z = -10. In the mirror stands the wall's image, in the same plane, so
// the view ray of a pixel that reflects the wall meets the image of the reflected point at distance 10. A camera that came from s m
// farther left saw what is at distance D f s / D px farther right: the reflection f s / 10, whatever the distance d of the mirror
// at that pixel. `surface` moves the reflection by f s / d, too far by f s (1/d - 1/10), with d = 1 / |slope|.
TEST(Reprojection, ACameraThatMovesSideways)
{
    Scene scene           = load_scene("builtin:mirror_floor_wall");
    scene.paths           = {{"truck", {level_camera({-0.1, 0, 0}), level_camera({0, 0, 0})}, 1}};
    const auto reflection = [](glm::dvec2, const Draw&) { return glm::dvec2(focal_px * 0.1 / 10, 0); };
    const auto mirror     = [](glm::dvec2 slope, const Draw&) { return glm::dvec2(focal_px * 0.1 * -slope.y, 0); };
    for (const int phases : {0, 16}) {
        expect_exact_strategies(scene, "truck", reflection, 10000, phases);
        const SecondFrame surface = second_frame(scene, "truck", "surface", phases);
        expect_exact(errors_of(scene, surface, mirror), 10000);
        // At the median row d is about 2 m: off by 90 * 0.1 * 0.4 px.
        EXPECT_GT(errors_of(scene, surface, reflection).median_px, 2) << "surface smears";
        expect_exact(errors_of(scene, second_frame(scene, "truck", "hit", phases), reflection), 10000);
    }
}

// A camera that comes forward by s: the image of the reflected point was at distance 10 + s, so its slope was 10 / (10 + s) times what
// it is. `hit` moves the reflection as the wall moves where it is seen, which is up instead of down: for a point that is seen in the
// mirror at slope -a and itself at slope b, off by f (a + b) s / (10 + s).
TEST(Reprojection, ACameraThatComesNearer)
{
    Scene scene           = load_scene("builtin:mirror_floor_wall");
    scene.paths           = {{"dolly", {level_camera({0, 0, 0.5}), level_camera({0, 0, 0})}, 1}};
    const auto reflection = [](glm::dvec2 slope, const Draw&) {
        return slope * (10 / 10.5 - 1) * glm::dvec2(focal_px, -focal_px);
    };
    expect_exact_strategies(scene, "dolly", reflection, 10000);
    for (const char* other : {"surface", "hit"})
        EXPECT_GT(errors_of(scene, second_frame(scene, "dolly", other), reflection).median_px, 1) << other;
}

// A level camera that turned by `turn` to the right saw the direction (x, y, -1) as (x cos + sin, y, x sin - cos), that of the image in
// the mirror as any other. The mirror's own motion is the same, so `surface` is right here; `hit` is not: the wall above moves
// otherwise than its image below.
TEST(Reprojection, ACameraThatTurns)
{
    constexpr double turn  = 0.03;
    Scene            scene = load_scene("builtin:mirror_floor_wall");
    scene.paths            = {{"turn", {level_camera({0, 0, 0}), level_camera({0, 0, 0}, turn)}, 1}};
    const auto reflection  = [](glm::dvec2 slope, const Draw&) {
        const double     forward = std::cos(turn) - slope.x * std::sin(turn);
        const glm::dvec2 before  = glm::dvec2(slope.x * std::cos(turn) + std::sin(turn), slope.y) / forward;
        return (before - slope) * glm::dvec2(focal_px, -focal_px);
    };
    expect_exact_strategies(scene, "turn", reflection, 10000);
    expect_exact(errors_of(scene, second_frame(scene, "turn", "surface"), reflection), 10000);
}

// The camera is still. The front of the sliding box of builtin:moving_boxes lies in z = -5.5, as does its image in the mirror; the box
// was 0.1 m farther left, and its reflection f 0.1 / 5.5 px. The mirror stands still, so `surface` is off by just that.
TEST(Reprojection, AnObjectThatSlides)
{
    const Scene scene      = load_scene("builtin:moving_boxes");
    const auto  reflection = [](glm::dvec2 slope, const Draw& hit) {
        const double y     = slope.y * 5.5; // of the image's front: between -1.5 and -2.5
        const bool   front = hit.name == "sliding box" && y < -1.5 && y > -2.5;
        return front ? glm::dvec2(-focal_px * 0.1 / 5.5, 0) : glm::dvec2(NAN);
    };
    expect_exact_strategies(scene, "default", reflection, 150);
    EXPECT_NEAR(errors_of(scene, second_frame(scene, "default", "surface"), reflection).median_px, focal_px * 0.1 / 5.5,
                0.01);
}

// The mirror rises by m = 0.05 m in each frame, and the images in it by 2 m: in the frame before, the wall's image was 0.1 m lower, at
// distance 10. The camera and the wall are still. Below slope -0.95 the mirror's point was outside the image: it cannot be rebuilt.
TEST(Reprojection, AMirrorThatRises)
{
    Scene scene = load_scene("builtin:mirror_floor_wall");
    for (Draw& draw : scene.draws)
        if (scene.materials[draw.material].metallic > 0) draw.motion.move_m = {0, 0.05, 0};
    const auto reflection = [](glm::dvec2 slope, const Draw&) {
        return glm::dvec2(slope.y < -0.94 ? NAN : 0, focal_px * 0.1 / 10);
    };
    expect_exact_strategies(scene, "default", reflection, 10000);
}

// The mirror turns about the z axis through (0, -1, 0) by 1 degree in each frame, and the images in it by 2 degrees: the point that is
// seen at (x, y, -10) now was 2 degrees less far about (0, -1). The normal has to turn with the mirror, not with the camera alone.
TEST(Reprojection, AMirrorThatTurns)
{
    constexpr double twice = 2 * std::numbers::pi / 180;
    Scene            scene = load_scene("builtin:mirror_floor_wall");
    for (Draw& draw : scene.draws)
        if (scene.materials[draw.material].metallic > 0) draw.motion = {.turn_deg = {0, 0, 1}, .pivot_ws = {0, -1, 0}};
    const auto reflection = [](glm::dvec2 slope, const Draw&) {
        const glm::dvec2 image = slope * 10.0 + glm::dvec2(0, 1);
        const glm::dvec2 before(image.x * std::cos(twice) + image.y * std::sin(twice),
                                image.y * std::cos(twice) - image.x * std::sin(twice) - 1);
        return (before / 10.0 - slope) * glm::dvec2(focal_px, -focal_px);
    };
    expect_exact_strategies(scene, "default", reflection, 5000);
}

// Rays of a rough mirror are drawn from its lobe, each as if a mirror of another normal had made it. The image is shifted and nothing moves, so
// no reflection does, in whichever mirror.
TEST(Reprojection, ARoughMirrorThatStandsStill)
{
    Scene scene = load_scene("builtin:mirror_floor_wall");
    for (Material& material : scene.materials)
        if (material.metallic > 0) material.roughness = 0.3F;
    const auto still = [](glm::dvec2, const Draw&) { return glm::dvec2(0); };
    for (const char* id : exact_strategies) {
        // Which pixels hit is known of mirror rays; some of the drawn ones miss, and have no vector.
        const SecondFrame frame  = second_frame(scene, "default", id, 16, {{"gloss", choice_value(Gloss::stochastic)}});
        const Errors      errors = errors_of(scene, frame, still);
        EXPECT_GT(errors.hits - errors.unseen, 20000U) << id;
        EXPECT_LT(errors.median_px, draws_exactly() ? 0.01 : 0.02) << id;
        EXPECT_LT(errors.p95_px, 0.5) << id << ": a box is met elsewhere than the plane of its pixel";
    }
}

// A mirror floor alone: what its rays miss is infinitely far. A camera's steps do not move the image of that. A camera that turns moves it as the
// image of any other point, and so does a mirror that turns: by 1 degree about z, and the direction's image by 2.
TEST(Reprojection, WhatRaysMissIsInfinitelyFar)
{
    constexpr double turn = 0.03, twice = 2 * std::numbers::pi / 180;
    Scene            scene = load_scene("builtin:mirror_floor_wall");
    std::erase_if(scene.draws, [&](const Draw& draw) { return scene.materials[draw.material].metallic == 0; });
    scene.paths                  = {{"step", {level_camera({-0.1, 0, 0.3}), level_camera({0, 0, 0})}, 1},
                                    {"turn", {level_camera({0, 0, 0}), level_camera({0, 0, 0}, turn)}, 1}};
    Scene turning                = scene;
    turning.draws.at(0).motion   = {.turn_deg = {0, 0, 1}, .pivot_ws = {0, -1, 0}};
    const auto expect_everywhere = [](const SecondFrame& frame, const auto& slope_before) {
        size_t judged = 0;
        for (size_t i = 0; i < frame.vectors_px.size(); ++i) {
            if (frame.hits.status[i] == TraceStatus::not_traced) continue;
            ASSERT_NE(frame.hits.status[i], TraceStatus::hit);
            const glm::dvec2 slope    = slope_of(i, frame.image.view);
            const glm::dvec2 expected = (slope_before(slope) - slope) * glm::dvec2(focal_px, -focal_px);
            ASSERT_NEAR(frame.vectors_px[i].x, expected.x, 0.01) << i;
            ASSERT_NEAR(frame.vectors_px[i].y, expected.y, 0.01) << i;
            ++judged;
        }
        EXPECT_GT(judged, 10000U);
    };
    for (const int phases : {0, 16}) {
        expect_everywhere(second_frame(scene, "step", "plane", phases), [](glm::dvec2 slope) { return slope; });
        expect_everywhere(second_frame(scene, "turn", "plane", phases), [](glm::dvec2 slope) {
            return glm::dvec2(slope.x * std::cos(turn) + std::sin(turn), slope.y) /
                   (std::cos(turn) - slope.x * std::sin(turn));
        });
        expect_everywhere(second_frame(turning, "default", "plane", phases), [](glm::dvec2 slope) {
            return glm::dvec2(slope.x * std::cos(twice) + slope.y * std::sin(twice),
                              slope.y * std::cos(twice) - slope.x * std::sin(twice));
        });
    }
}

} // namespace
} // namespace ssrlab::test
