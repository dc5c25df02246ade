// Where a reflection was in the frame before, against closed forms.
#include "truth/reprojection_truth.h"
#include "truth_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ssrlab {
namespace {

using namespace test;

constexpr double wall_m   = 10;
constexpr double exact_px = 1e-4; // depths and normals are floats

/// Mirror floor at y = -1 and a wall 10 m ahead, seen from the origin; nothing has moved yet.
struct Frames {
    Scene        now, before;
    GBufferImage gbuffer = floor_and_wall(bench_view({64, 64}), wall_m);
    FrameMotion  motion;

    Frames()
    {
        const uint32_t mirror = add_material(now, {1, 1, 1}, 1), dull = add_material(now, {0.5F, 0.5F, 0.5F}, 0);
        add_floor(now, mirror);
        add_wall(now, dull, wall_m);
        for (size_t i = 0; i < gbuffer.depth.size(); ++i)
            gbuffer.object_id[i] = gbuffer.depth[i] == 0 ? 0 : gbuffer.metallic[i] > 0 ? 1 : 2;
        motion.view = motion.previous_view = gbuffer.view;
        before                             = now;
        motion.to_previous_ws.assign(now.draws.size(), glm::dmat4(1));
    }

    /// Draw `draw` was elsewhere.
    void move_back(uint32_t draw, const glm::dmat4& to_previous)
    {
        motion.to_previous_ws[draw] = to_previous;
        const Draw& moved           = before.draws[draw];
        for (uint32_t i = moved.first_index; i < moved.first_index + moved.index_count; ++i)
            before.vertices[now.indices[i]].position_ws =
                glm::vec3(to_previous * glm::dvec4(now.vertices[now.indices[i]].position_ws, 1));
    }

    ReprojectionTruth truth() const { return reprojection_truth(SceneBvh(now), SceneBvh(before), gbuffer, motion); }
};

/// The slope (x right, y up) at which the mirror image of what a pixel shows was seen, from that at which it is.
using PreviousSlope = std::function<glm::dvec2(glm::dvec2)>;

void expect_everywhere(const Frames& frames, const PreviousSlope& previous_slope, int at_least)
{
    const ReprojectionTruth truth = frames.truth();
    const View&             view  = frames.motion.view;
    int                     seen  = 0;
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        if (truth.cls[i] == ReprojectionClass::not_reflecting) continue;
        ASSERT_NE(truth.cls[i], ReprojectionClass::unknown) << x << ' ' << y;
        if (truth.cls[i] != ReprojectionClass::seen) continue;
        ++seen;
        const glm::dvec2 slope = (glm::dvec2(x + 0.5, y + 0.5) - frames.gbuffer.view.centre_px) / view.focal_px;
        const glm::dvec2 was   = previous_slope({slope.x, -slope.y});
        const glm::dvec2 moved = (glm::dvec2(was.x, -was.y) - slope) * view.focal_px;
        ASSERT_NEAR(truth.displacement_px[i].x, moved.x, exact_px) << x << ' ' << y;
        ASSERT_NEAR(truth.displacement_px[i].y, moved.y, exact_px) << x << ' ' << y;
    }
    EXPECT_GE(seen, at_least);
}

// The mirror image of the wall is a wall, 10 m away like the wall itself, whatever the distance of the floor between: a camera that
// moved by s to the right saw it s / 10 farther to the right, and the floor s / distance, which is more.
TEST(ReprojectionTruth, ACameraThatMovesSidewaysOverAMirrorFloor)
{
    Frames frames;
    frames.motion.previous_view.world_to_view = glm::translate(glm::dmat4(1), glm::dvec3(0.5, 0, 0));
    expect_everywhere(
        frames, [](glm::dvec2 slope) { return slope + glm::dvec2(0.05, 0); }, 28 * 60);
}

// A camera that moved ahead by s saw the image at 10 + s.
TEST(ReprojectionTruth, ACameraThatMovesAhead)
{
    Frames frames;
    frames.motion.previous_view.world_to_view = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -0.5));
    expect_everywhere(
        frames, [](glm::dvec2 slope) { return slope * (10 / 10.5); }, 28 * 60);
}

// A turn moves directions alone: (sx, sy, -1) was (sx cos + sin, sy, sx sin - cos).
TEST(ReprojectionTruth, ACameraThatTurns)
{
    constexpr double turn = 0.05;
    Frames           frames;
    frames.motion.previous_view.world_to_view = glm::rotate(glm::dmat4(1), -turn, {0, 1, 0});
    const PreviousSlope turned                = [](glm::dvec2 slope) {
        return glm::dvec2(slope.x * std::cos(turn) + std::sin(turn), slope.y) /
               (std::cos(turn) - slope.x * std::sin(turn));
    };
    expect_everywhere(frames, turned, 28 * 58);
    // Jitter of this frame's image is no motion.
    frames.gbuffer = floor_and_wall(frames.gbuffer.view, wall_m);
    frames.gbuffer.view.centre_px += glm::dvec2(0.3, 0);
    for (size_t i = 0; i < frames.gbuffer.depth.size(); ++i)
        frames.gbuffer.object_id[i] = frames.gbuffer.depth[i] == 0 ? 0 : frames.gbuffer.metallic[i] > 0 ? 1 : 2;
    expect_everywhere(frames, turned, 28 * 58);
}

// The wall was 0.2 m to the left and 0.3 m higher: its image was as far to the left, and lower.
TEST(ReprojectionTruth, AnObjectThatMoves)
{
    Frames frames;
    frames.move_back(1, glm::translate(glm::dmat4(1), glm::dvec3(-0.2, 0.3, 0)));
    expect_everywhere(
        frames, [](glm::dvec2 slope) { return slope + glm::dvec2(-0.02, -0.03); }, 28 * 60);
}

// The floor was 0.1 m lower: images in it were lower by twice that.
TEST(ReprojectionTruth, AMirrorThatMoves)
{
    Frames frames;
    frames.move_back(0, glm::translate(glm::dmat4(1), glm::dvec3(0, -0.1, 0)));
    expect_everywhere(
        frames, [](glm::dvec2 slope) { return slope - glm::dvec2(0, 0.02); }, 28 * 55);
}

// About the camera's axis: the wall's image was turned by twice the angle.
TEST(ReprojectionTruth, AMirrorThatTurns)
{
    constexpr double angle = 0.02;
    const glm::dvec3 middle(0, -1, 0);
    Frames           frames;
    frames.move_back(0, glm::translate(glm::rotate(glm::translate(glm::dmat4(1), middle), angle, {0, 0, 1}), -middle));
    expect_everywhere(
        frames,
        [](glm::dvec2 slope) {
            const glm::dvec2 on_floor(0, -1), normal(-std::sin(angle), std::cos(angle));
            const glm::dvec2 on_wall(wall_m * slope.x, -2 - wall_m * slope.y);
            return (on_wall - 2 * glm::dot(normal, on_wall - on_floor) * normal) / wall_m;
        },
        28 * 40);
}

// Without a wall the floor reflects the sky, which is infinitely far away: it does not move under a camera that does.
TEST(ReprojectionTruth, TheSkyStandsStill)
{
    Frames frames;
    frames.now.draws[1].index_count = frames.before.draws[1].index_count = 0;
    frames.motion.previous_view.world_to_view = glm::translate(glm::dmat4(1), glm::dvec3(3, 0, -2));
    expect_everywhere(
        frames, [](glm::dvec2 slope) { return slope; }, 28 * 60);
}

// A post stood between the floor and the wall in the frame before, at x = -1 … 1: its image and itself hid the wall's image.
TEST(ReprojectionTruth, WhatWasHiddenIsSaidToBe)
{
    Frames frames;
    for (Scene* scene : {&frames.now, &frames.before})
        add_quad(*scene, 1, {scene == &frames.now ? -99.0 : -1.0, -1, -5}, {2, 0, 0}, {0, 9, 0});
    frames.motion.to_previous_ws.push_back(glm::translate(glm::dmat4(1), glm::dvec3(98, 0, 0)));
    const ReprojectionTruth truth = frames.truth();
    // The floor ends at row 35.2. The sight of the image crosses z = -5, directly or mirrored, at heights from -1 to 3 m; 1 m is 6.4 px there.
    for (int y = 36; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const bool inside = std::abs(x + 0.5 - 32) < 6.4;
            EXPECT_EQ(truth.cls[at(frames.gbuffer, x, y)], inside ? ReprojectionClass::hidden : ReprojectionClass::seen)
                << x << ' ' << y;
        }
    frames.motion.previous_view.world_to_view = glm::translate(glm::dmat4(1), glm::dvec3(50, 0, 0));
    EXPECT_EQ(frames.truth().cls[at(frames.gbuffer, 3, 50)], ReprojectionClass::off_screen);
}

// A rug lay on the floor in the frame before, from 1.5 to 9 m and at x = -1.01 … 1.01: it is in the mirror's plane, but no part of the mirror.
TEST(ReprojectionTruth, WhatLayOnTheMirrorHidIt)
{
    Frames frames;
    for (Scene* scene : {&frames.now, &frames.before})
        add_quad(*scene, 1, {scene == &frames.now ? -99.01 : -1.01, -1 + 1e-6, -1.5}, {2.02, 0, 0}, {0, 0, -7.5});
    frames.motion.to_previous_ws.push_back(glm::translate(glm::dmat4(1), glm::dvec3(98, 0, 0)));
    const ReprojectionTruth truth = frames.truth();
    for (int y = 36; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double floor_m = 32 / (y + 0.5 - 32);
            const bool   on_rug  = floor_m > 1.5 && floor_m < 9 && std::abs(x + 0.5 - 32) * floor_m < 32 * 1.01;
            EXPECT_EQ(truth.cls[at(frames.gbuffer, x, y)], on_rug ? ReprojectionClass::hidden : ReprojectionClass::seen)
                << x << ' ' << y;
        }
}

/// A mirror sphere of radius 1 at (0, 0, -4), and a wall behind the camera that it shows.
struct SphereFrames : Frames {
    static constexpr glm::dvec3 centre{0, 0, -4};

    SphereFrames()
    {
        now = before          = {};
        const uint32_t mirror = add_material(now, {1, 1, 1}, 1), dull = add_material(now, {0.5F, 0.5F, 0.5F}, 0);
        add_sphere(now, mirror, centre, 1, 256);
        add_quad(now, dull, {40, -40, 6}, {-80, 0, 0}, {0, 80, 0});
        before  = now;
        gbuffer = empty_gbuffer(bench_view({64, 64}));
        for (const auto [i, x, y] : pixels_of({64, 64})) {
            const glm::dvec3 along = glm::normalize(glm::dvec3((x + 0.5) / 32 - 1, 1 - (y + 0.5) / 32, -1));
            const double     half = glm::dot(along, centre), square = half * half - (16 - 1);
            if (square < 0.1) continue; // near its edge a pixel shows much of the room
            const glm::dvec3 point = (half - std::sqrt(square)) * along;
            set_pixel(gbuffer, x, y, -point.z, point - centre, 1);
            gbuffer.object_id[at(gbuffer, x, y)] = 1;
        }
        motion.to_previous_ws.assign(2, glm::dmat4(1));
    }

    /// Where the eye sees `point` in the sphere: in their plane with the centre, where the normal halves the angle between both.
    static glm::dvec3 reflection_point(glm::dvec3 eye, glm::dvec3 point)
    {
        const glm::dvec3 to_eye = glm::normalize(eye - centre),
                         normal = glm::cross(to_eye, glm::normalize(point - centre));
        const glm::dvec3 across = glm::normalize(glm::cross(normal, to_eye));
        double           low = 0, high = std::asin(std::min(glm::length(normal), 1.0));
        for (int i = 0; i < 60; ++i) {
            const double     angle = 0.5 * (low + high);
            const glm::dvec3 out = std::cos(angle) * to_eye + std::sin(angle) * across, at = centre + out;
            const glm::dvec3 along  = std::cos(angle) * across - std::sin(angle) * to_eye;
            const double     tilt   = glm::dot(along, glm::normalize(eye - at) + glm::normalize(point - at));
            (tilt > 0 ? low : high) = angle;
        }
        return centre + std::cos(low) * to_eye + std::sin(low) * across;
    }
};

// Each pixel's mirror ray meets the wall at z = 6; there the ideal sphere shows it to the eye of the frame before by bisection. Triangles
// of a 256th of the half turn differ from the sphere by 1e-5 of its radius.
TEST(ReprojectionTruth, ASphere)
{
    SphereFrames     frames;
    const glm::dvec3 eye(-0.3, 0.2, 0.1);
    frames.motion.previous_view.world_to_view = glm::translate(glm::dmat4(1), -eye);
    frames.move_back(1, glm::translate(glm::dmat4(1), glm::dvec3(0.5, 0, 0)));
    const ReprojectionTruth truth = frames.truth();
    int                     seen  = 0;
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        if (frames.gbuffer.depth[i] == 0) continue;
        const glm::dvec3 along = glm::normalize(glm::dvec3((x + 0.5) / 32 - 1, 1 - (y + 0.5) / 32, -1));
        const double     half  = glm::dot(along, SphereFrames::centre);
        const glm::dvec3 point = (half - std::sqrt(half * half - 15)) * along;
        const glm::dvec3 out   = glm::reflect(along, point - SphereFrames::centre);
        if (out.z < 0.2) continue; // rays that pass the wall
        const glm::dvec3 target = point + out * ((6 - point.z) / out.z) + glm::dvec3(0.5, 0, 0);
        if (std::abs(target.x) > 39 || std::abs(target.y) > 39) continue;
        const glm::dvec3 from = SphereFrames::reflection_point(eye, target) - eye;
        const glm::dvec2 expected(32 * (1 + from.x / -from.z), 32 * (1 - from.y / -from.z));
        ASSERT_EQ(truth.cls[i], ReprojectionClass::seen) << x << ' ' << y;
        EXPECT_NEAR(x + 0.5 + truth.displacement_px[i].x, expected.x, 0.01) << x << ' ' << y;
        EXPECT_NEAR(y + 0.5 + truth.displacement_px[i].y, expected.y, 0.01) << x << ' ' << y;
        ++seen;
    }
    EXPECT_GT(seen, 90); // of 190 that the disc of 8 px covers, those that reflect the wall
}

TEST(ReprojectionTruth, MirrorsWithANormalMapHaveNoAnswer)
{
    Frames frames;
    frames.now.materials[0].normal_texture.texture = 0;
    const ReprojectionTruth truth                  = frames.truth();
    EXPECT_EQ(std::ranges::count(truth.cls, ReprojectionClass::unknown), 64 * 29);
}

} // namespace
} // namespace ssrlab
