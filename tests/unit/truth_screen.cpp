// The screen truth on G-buffers with closed-form answers.
#include "truth/screen_truth.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr double infinity  = std::numeric_limits<double>::infinity();
constexpr double quiet_nan = std::numeric_limits<double>::quiet_NaN();

int count(const TraceImage& result, TraceStatus status)
{
    return int(std::count(result.status.begin(), result.status.end(), status));
}

// The mirror image of the camera (height 1 above the floor) sees the wall point (Y_w) at py' = 32 (1 + (Y_w + 2) / 10) on the
// floor, and the camera itself at py = 32 (1 - Y_w / 10): the two add up to 64 + 6.4 = 70.4 for every column.
TEST(ScreenTruth, MirrorFloorShowsWallInExactRow)
{
    const GBufferImage gbuffer = floor_and_wall(bench_view({64, 64}), 10);
    const TraceImage   result  = screen_truth(gbuffer, boxes());
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        if (y + 0.5 < 35.2) {
            EXPECT_EQ(result.status[i], TraceStatus::not_traced);
            continue;
        }
        const double expected_py = 70.4 - (y + 0.5);
        ASSERT_EQ(result.status[i], TraceStatus::hit) << x << ' ' << y;
        EXPECT_EQ(result.hit_pixel[i], glm::ivec2(x, int(std::floor(expected_py))));
        EXPECT_NEAR(result.hit_px_depth[i].y, expected_py, 2e-5);
        EXPECT_NEAR(result.hit_px_depth[i].x, x + 0.5, 1e-12);
        EXPECT_NEAR(result.hit_px_depth[i].z, 0.01, 1e-8);
        EXPECT_EQ(result.steps[i], uint32_t(y - std::floor(expected_py)));
    }
}

// A floor cannot reflect itself: n rows up the ray is (n/2 - 1/4) rows' worth of depth in front of the floor's pixel.
TEST(ScreenTruth, FloorAloneIsNeverHit)
{
    for (const glm::ivec2& size : {glm::ivec2(1, 1), {3, 2}, {1, 16}, {97, 1}, {161, 91}, {641, 363}}) {
        for (const double max_distance_m : {0.5, 100.0, 1e9, infinity}) {
            TraceSettings settings     = boxes();
            settings.max_distance_m    = max_distance_m;
            settings.thickness_m       = infinity;
            const GBufferImage gbuffer = floor_and_wall(bench_view(size), infinity);
            const TraceImage   result  = screen_truth(gbuffer, settings);
            EXPECT_EQ(count(result, TraceStatus::hit), 0);
            EXPECT_EQ(count(result, TraceStatus::not_traced) + count(result, TraceStatus::past_max_distance) +
                          count(result, TraceStatus::left_screen),
                      size.x * size.y);
        }
    }
}

TEST(ScreenTruth, AllBackgroundIsNotTraced)
{
    const TraceImage result = screen_truth(empty_gbuffer(bench_view({5, 4})), boxes());
    EXPECT_EQ(count(result, TraceStatus::not_traced), 20);
}

TEST(ScreenTruth, UnusablePixelsAreNotTraced)
{
    GBufferImage gbuffer                 = floor_and_wall(bench_view({8, 8}), infinity);
    gbuffer.normal_vs[at(gbuffer, 0, 7)] = glm::vec3(0);
    gbuffer.normal_vs[at(gbuffer, 1, 7)] = glm::vec3(0, float(quiet_nan), 0);
    gbuffer.normal_vs[at(gbuffer, 2, 7)] = glm::vec3(0, float(infinity), 0);
    gbuffer.metallic[at(gbuffer, 3, 7)]  = 0;
    gbuffer.depth[at(gbuffer, 4, 7)]     = float(quiet_nan);
    gbuffer.depth[at(gbuffer, 5, 7)]     = float(infinity);
    gbuffer.depth[at(gbuffer, 6, 7)]     = -1;
    const TraceImage result              = screen_truth(gbuffer, boxes());
    for (int x = 0; x < 7; ++x) EXPECT_EQ(result.status[at(gbuffer, x, 7)], TraceStatus::not_traced) << x;
    EXPECT_NE(result.status[at(gbuffer, 7, 7)], TraceStatus::not_traced);
}

/// A ray at Z = 5 parallel to the image, from (48.5, 20.5) to the left over 48 px. near = 1/8 makes its depth exact.
ScreenRay sideways_ray()
{
    ScreenRay ray;
    ray.traced          = true;
    ray.origin_px_depth = {48.5, 20.5, 0.125 / 5};
    ray.delta_px_depth  = {-48, 0, 0};
    ray.start_pixel     = {48, 20};
    ray.end_status      = TraceStatus::left_screen;
    return ray;
}

GBufferImage left_columns_nearer(int last_column, double distance_m)
{
    GBufferImage gbuffer = empty_gbuffer(bench_view({64, 64}, 0.125));
    for (const auto [i, x, y] : pixels_of({64, 64}))
        set_pixel(gbuffer, x, y, x <= last_column ? distance_m : 10, {0, 0, 1}, 0);
    return gbuffer;
}

TEST(ScreenTruth, SidewaysRayEntersSlabFromTheSide)
{
    const GBufferImage gbuffer  = left_columns_nearer(15, 2);
    TraceSettings      settings = boxes();
    settings.thickness_m        = 3;
    const WalkResult hit        = ScreenWalk(gbuffer, settings).walk(sideways_ray());
    EXPECT_EQ(hit.status, TraceStatus::hit);
    EXPECT_EQ(hit.hit_pixel, glm::ivec2(15, 20));
    EXPECT_DOUBLE_EQ(hit.hit_t, (48.5 - 16) / 48);
    settings.thickness_m  = 1;
    const WalkResult miss = ScreenWalk(gbuffer, settings).walk(sideways_ray());
    EXPECT_EQ(miss.status, TraceStatus::left_screen);
    EXPECT_EQ(miss.pixels, 48U);
}

// A pole of one pixel at Z = 4: the ray at Z = 5 touches its back exactly when the thickness is 1, and equality counts.
TEST(ScreenTruth, PoleThicknessIsInclusive)
{
    GBufferImage gbuffer = left_columns_nearer(-1, 0);
    for (int y = 0; y < 64; ++y) set_pixel(gbuffer, 20, y, 4, {0, 0, 1}, 0);
    for (const auto& [thickness_m, hits] :
         {std::pair(1.0, true), {1.5, true}, {infinity, true}, {0.999999, false}, {0.0, false}}) {
        TraceSettings settings = boxes();
        settings.thickness_m   = thickness_m;
        const WalkResult found = ScreenWalk(gbuffer, settings).walk(sideways_ray());
        EXPECT_EQ(found.status == TraceStatus::hit, hits) << thickness_m;
        if (hits) {
            EXPECT_EQ(found.hit_pixel.x, 20);
        }
        settings.thickness_relative = true;
        settings.thickness_m        = thickness_m / 4;
        EXPECT_EQ(ScreenWalk(gbuffer, settings).walk(sideways_ray()).status == TraceStatus::hit, hits) << thickness_m;
    }
}

TEST(ScreenTruth, ThicknessZeroHitsOnlyByExactContact)
{
    TraceSettings settings = boxes();
    settings.thickness_m   = 0;
    GBufferImage gbuffer   = left_columns_nearer(15, 4);
    EXPECT_EQ(ScreenWalk(gbuffer, settings).walk(sideways_ray()).status, TraceStatus::left_screen);
    ScreenRay ray         = sideways_ray();
    ray.origin_px_depth.z = 0.125 / 4;
    EXPECT_EQ(ScreenWalk(gbuffer, settings).walk(ray).status, TraceStatus::hit);
    // The ray's depth interval in a pixel contains the surface although no thickness helps.
    ray.origin_px_depth.z = 0.125 / 4 + 0.001;
    ray.delta_px_depth.z  = -0.002;
    EXPECT_EQ(ScreenWalk(gbuffer, settings).walk(ray).status,
              TraceStatus::left_screen);          // passes Z = 4 before column 15
    ray.delta_px_depth.z   = -0.001 * 48 / 40.25; // crosses Z = 4 at px 8.25
    const WalkResult found = ScreenWalk(gbuffer, settings).walk(ray);
    EXPECT_EQ(found.status, TraceStatus::hit);
    EXPECT_EQ(found.hit_pixel, glm::ivec2(8, 20));
    EXPECT_NEAR(found.hit_px_depth.x, 8.25, 1e-9);
}

TEST(ScreenTruth, ComingFromBehindHitsTheBack)
{
    // Columns up to 15 at Z = 2 with slab to Z = 4 (depth 1/32). The ray rises from Z = 5 and reaches 1/32 at px 8.25.
    const GBufferImage gbuffer  = left_columns_nearer(15, 2);
    TraceSettings      settings = boxes();
    settings.thickness_m        = 2;
    ScreenRay ray               = sideways_ray();
    ray.delta_px_depth.z        = (1.0 / 32 - 0.025) * 48 / 40.25;
    const WalkResult found      = ScreenWalk(gbuffer, settings).walk(ray);
    EXPECT_EQ(found.status, TraceStatus::hit);
    EXPECT_EQ(found.hit_pixel, glm::ivec2(8, 20));
    EXPECT_NEAR(found.hit_px_depth.x, 8.25, 1e-9);
}

TEST(ScreenTruth, CornerCrossesBothBorders)
{
    const GBufferImage gbuffer = empty_gbuffer(bench_view({64, 64}));
    for (const glm::dvec2& way : {glm::dvec2(1, 1), {1, -1}, {-1, 1}, {-1, -1}}) {
        ScreenRay ray       = sideways_ray();
        ray.origin_px_depth = {30.5, 30.5, 0.02};
        ray.start_pixel     = {30, 30};
        ray.delta_px_depth  = glm::dvec3(20.0 * way, 0);
        EXPECT_EQ(ScreenWalk(gbuffer, boxes()).walk(ray).pixels, 20U);
    }
}

TEST(ScreenTruth, NegativeZeroAndTinyComponentsBehaveAsZero)
{
    const GBufferImage gbuffer = left_columns_nearer(-1, 0);
    for (const double tiny : {0.0, -0.0, 1e-310, -1e-310, 1e-30, -1e-30}) {
        ScreenRay ray        = sideways_ray();
        ray.delta_px_depth.y = tiny;
        EXPECT_EQ(ScreenWalk(gbuffer, boxes()).walk(ray).pixels, 48U);
    }
    ScreenRay still      = sideways_ray();
    still.delta_px_depth = glm::dvec3(0);
    EXPECT_EQ(ScreenWalk(gbuffer, boxes()).walk(still).pixels, 0U);
}

TEST(ScreenTruth, FacingRule)
{
    GBufferImage  gbuffer  = floor_and_wall(bench_view({64, 64}), 10);
    TraceSettings settings = boxes();
    settings.behind        = Behind::pass;
    EXPECT_EQ(count(screen_truth(gbuffer, settings), TraceStatus::hit), 64 * 29);
    for (auto& normal_vs : gbuffer.normal_vs) {
        if (normal_vs.z > 0) normal_vs.z = -1;
    }
    EXPECT_EQ(count(screen_truth(gbuffer, settings), TraceStatus::facing_away), 64 * 29);
}

TEST(ScreenTruth, OrthographicClosedForms)
{
    // Visible height 8 m over 64 rows: 8 px per metre. The mirror at Z = 20 with normal (0, 1, 1) sends rays straight up; a block
    // over rows 0..9 at the same distance is met at its lower border, at Z = 19 only if the slab reaches 20.
    View view;
    view.size_px         = {64, 64};
    view.projection      = Projection::orthographic;
    view.focal_px        = {8, 8};
    view.centre_px       = {32, 32};
    view.near_m          = 0;
    view.far_m           = 128;
    GBufferImage gbuffer = empty_gbuffer(view);
    const double tilt    = std::numbers::pi / 8;
    set_pixel(gbuffer, 5, 60, 20, {0, 1, 1}, 1);
    set_pixel(gbuffer, 7, 60, 20, {0, std::cos(tilt), std::sin(tilt)}, 1);
    set_pixel(gbuffer, 9, 60, 20, {0, 0, 1}, 1); // back along the axis: it never leaves its pixel
    for (int x = 0; x < 64; ++x) {
        for (int y = 0; y < 10; ++y) set_pixel(gbuffer, x, y, x == 7 ? 26 : 19.5, {0, 0, 1}, 0);
    }
    TraceSettings settings = boxes();
    settings.thickness_m   = 1;
    TraceImage result      = screen_truth(gbuffer, settings);
    EXPECT_EQ(result.status[at(gbuffer, 5, 60)], TraceStatus::hit);
    EXPECT_EQ(result.hit_pixel[at(gbuffer, 5, 60)], glm::ivec2(5, 9));
    EXPECT_NEAR(result.hit_px_depth[at(gbuffer, 5, 60)].y, 10, 1e-9);
    // At 45 degrees up and away it reaches row 10 after 50.5 px = 6.3125 m, at Z = 26.3125: inside the slab from 26 to 27.
    EXPECT_EQ(result.hit_pixel[at(gbuffer, 7, 60)], glm::ivec2(7, 9));
    EXPECT_NEAR(result.hit_px_depth[at(gbuffer, 7, 60)].y, 10, 1e-4);
    EXPECT_EQ(result.status[at(gbuffer, 9, 60)], TraceStatus::left_screen);
    EXPECT_EQ(result.steps[at(gbuffer, 9, 60)], 0U);
    settings.thickness_m = 0.25;
    EXPECT_EQ(screen_truth(gbuffer, settings).status[at(gbuffer, 5, 60)], TraceStatus::left_screen);
}

} // namespace
} // namespace ssrlab
