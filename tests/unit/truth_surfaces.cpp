// The surface models of docs/reference/hit_contract.md in the screen truth: closed forms, and a second definition of the meeting.
#include "core/error.h"
#include "truth/screen_truth.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr double infinity  = std::numeric_limits<double>::infinity();
constexpr float  quiet_nan = std::numeric_limits<float>::quiet_NaN();

constexpr std::array all_models = {"box", "box_two_sided", "box_infinite", "plane", "plane_solid", "plane_infinite"};

View orthographic_view(glm::ivec2 size_px)
{
    View view       = bench_view(size_px);
    view.projection = Projection::orthographic;
    view.focal_px   = {5, 5};
    view.near_m     = 2;
    view.far_m      = 10;
    return view;
}

/// One picture of 9 x 3 pixels, all background but pixel (4, 1).
GBufferImage single_pixel(double depth, glm::vec2 gradient, float solid_back = 0, View view = bench_view({9, 3}, 0.125))
{
    GBufferImage gbuffer = empty_gbuffer(view);
    gbuffer.gradient.assign(gbuffer.depth.size(), glm::vec2(quiet_nan));
    gbuffer.solid_back.assign(gbuffer.depth.size(), 0);
    const size_t i        = at(gbuffer, 4, 1);
    gbuffer.depth[i]      = float(depth);
    gbuffer.normal_vs[i]  = {0, 0, 1};
    gbuffer.gradient[i]   = gradient;
    gbuffer.solid_back[i] = solid_back;
    return gbuffer;
}

/// Along the middle row from x = 0.5 to 8.5, so that it is in the pixel from t = 7/16 to 9/16, at its centre at 1/2. Depths there.
ScreenRay ray_through(double z_in, double z_out)
{
    const double slope = (z_out - z_in) * 8;
    ScreenRay    ray;
    ray.traced          = true;
    ray.start_pixel     = {0, 1};
    ray.end_status      = TraceStatus::left_screen;
    ray.origin_px_depth = {0.5, 1.5, z_in - slope * 7 / 16};
    ray.delta_px_depth  = {8, 0, slope};
    ray.direction_vs    = glm::normalize(glm::dvec3(1, 0, -0.1)); // against the normal (0, 0, 1)
    return ray;
}

WalkResult answer(const GBufferImage& gbuffer, const ScreenRay& ray, std::string_view surface,
                  Behind behind = Behind::stop, double thickness_m = 1)
{
    TraceSettings settings;
    settings.surface     = surface;
    settings.behind      = behind;
    settings.thickness_m = thickness_m;
    return ScreenWalk(gbuffer, settings).walk(ray);
}

void expect_at(const WalkResult& found, TraceStatus status, double t)
{
    EXPECT_EQ(found.status, status);
    EXPECT_EQ(found.hit_pixel, glm::ivec2(4, 1));
    EXPECT_NEAR(found.hit_t, t, 1e-12);
}

constexpr double t_in = 7 / 16.0, t_middle = 0.5, t_out = 9 / 16.0;

// Depth 1/32 is 4 m; the slab of 1 m is from 3 m (1/24) over 4 m to 5 m (1/40).
TEST(SurfaceModels, TwoSidedBoxBeginsBeforeItsPixel)
{
    const GBufferImage gbuffer = single_pixel(1 / 32.0, {0, 0});
    const ScreenRay    level = ray_through(1 / 28.0, 1 / 28.0), nearer = ray_through(1 / 23.0, 1 / 23.0);
    EXPECT_EQ(answer(gbuffer, level, "box").status, TraceStatus::left_screen);
    expect_at(answer(gbuffer, level, "box_two_sided"), TraceStatus::hit, t_in);
    EXPECT_EQ(answer(gbuffer, nearer, "box_two_sided").status, TraceStatus::left_screen);
    expect_at(answer(gbuffer, ray_through(1 / 20.0, 1 / 20.0 - 2 * (1 / 20.0 - 1 / 24.0)), "box_two_sided"),
              TraceStatus::hit, t_middle);
    // As far before the pixel as the eye is: everything in front of it.
    for (const double thickness_m : {4.0, 5.0, infinity})
        expect_at(answer(gbuffer, ray_through(0.9, 0.9), "box_two_sided", Behind::stop, thickness_m), TraceStatus::hit,
                  t_in);
    TraceSettings relative      = boxes();
    relative.thickness_relative = true;
    relative.thickness_m        = 0.25;
    EXPECT_DOUBLE_EQ(slab_front(gbuffer.view, 1 / 32.0, relative), 1 / 24.0);
    relative.thickness_m = 1;
    EXPECT_EQ(slab_front(gbuffer.view, 1 / 32.0, relative), infinity);
    const View    orthographic = orthographic_view({9, 3});
    TraceSettings settings     = boxes();
    settings.thickness_m       = 1; // of 8 m
    EXPECT_DOUBLE_EQ(slab_front(orthographic, 0.5, settings), 0.625);
    settings.thickness_m = 6; // the pixel is at 6 m
    EXPECT_EQ(slab_front(orthographic, 0.5, settings), infinity);
}

TEST(SurfaceModels, InfiniteBoxHoldsEverythingBehindIt)
{
    const GBufferImage gbuffer = single_pixel(1 / 32.0, {0, 0});
    expect_at(answer(gbuffer, ray_through(0, 0), "box_infinite"), TraceStatus::hit, t_in);
    expect_at(answer(gbuffer, ray_through(1 / 32.0, 1 / 32.0), "box_infinite"), TraceStatus::hit, t_in);
    EXPECT_EQ(answer(gbuffer, ray_through(1 / 31.0, 1 / 31.0), "box_infinite").status, TraceStatus::left_screen);
}

TEST(SurfaceModels, BoxIsMetFromBehindWhereItsNormalFacesAway)
{
    GBufferImage    gbuffer = single_pixel(1 / 32.0, {0, 0});
    const ScreenRay ray     = ray_through(1 / 36.0, 1 / 36.0);
    for (const glm::vec3& away : {glm::vec3(0, 0, -1), {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {quiet_nan, 0, 0}}) {
        gbuffer.normal_vs[at(gbuffer, 4, 1)] = away;
        expect_at(answer(gbuffer, ray, "box", Behind::hit), TraceStatus::hit, t_in);
        expect_at(answer(gbuffer, ray, "box", Behind::stop), TraceStatus::stopped, t_in);
        EXPECT_EQ(answer(gbuffer, ray, "box", Behind::pass).status, TraceStatus::facing_away);
    }
    gbuffer.normal_vs[at(gbuffer, 4, 1)] = {-1, 0, 0};
    expect_at(answer(gbuffer, ray, "box", Behind::stop), TraceStatus::hit, t_in);
}

// The plane rises by 1/64 a pixel: from 1/32 - 1/128 at the entry to 1/32 + 1/128 at the exit.
TEST(SurfaceModels, SlopingPlaneIsMetWhereItIs)
{
    constexpr double   d = 1 / 32.0, half = 1 / 128.0, e = d / 1024;
    const GBufferImage gbuffer = single_pixel(d, {float(2 * half), 0});
    const auto         meets   = [&](double z_in, double z_out, Behind behind = Behind::stop) {
        return answer(gbuffer, ray_through(z_in, z_out), "plane", behind);
    };
    expect_at(meets(d, d), TraceStatus::hit, t_middle);                   // level, from above
    expect_at(meets(d - half, d + half), TraceStatus::hit, t_in);         // in the front itself
    expect_at(meets(d - half - e, d + half - e), TraceStatus::hit, t_in); // in the back itself
    EXPECT_EQ(meets(d - half - 1.01 * e, d + half - 1.01 * e).status, TraceStatus::left_screen);
    EXPECT_EQ(meets(d + 1e-9, d + half + 1e-9).status, TraceStatus::left_screen);
    expect_at(meets(d + half, d + half), TraceStatus::hit, t_out);             // touches at the exit: equality counts
    EXPECT_EQ(meets(d - 2 * half, d - half).status, TraceStatus::left_screen); // below all the way
    // From below: along a line that is half a pixel's rise below at the entry and as much above at the exit.
    for (const auto& [behind, status] :
         {std::pair(Behind::stop, TraceStatus::stopped), {Behind::hit, TraceStatus::hit}})
        expect_at(meets(d - 2 * half - e, d + 2 * half - e, behind), status, t_middle);
    EXPECT_EQ(meets(d - 2 * half, d + 2 * half, Behind::pass).status, TraceStatus::facing_away);
}

// A ray that runs along the row over a plane that rises across it meets the front that lies there, not the pixel's depth.
TEST(SurfaceModels, PlaneIsTakenAtTheRaysPlaceInThePixel)
{
    const GBufferImage gbuffer = single_pixel(1 / 32.0, {0, 1 / 64.0F});
    for (const double y : {1.25, 1.5, 1.75}) {
        const double front = 1 / 32.0 + (y - 1.5) / 64;
        for (const double above : {1e-6, -1e-6, -1e-4}) {
            ScreenRay ray         = ray_through(front + above, front + above);
            ray.origin_px_depth.y = y;
            const bool hits       = above == -1e-6;
            EXPECT_EQ(answer(gbuffer, ray, "plane").status, hits ? TraceStatus::hit : TraceStatus::left_screen);
        }
    }
}

TEST(SurfaceModels, PlaneAtAPixelsCorner)
{
    // Front 0 at the far corner of the pixel: a diagonal ray meets it there exactly, by equality alone.
    const double       d       = 1 / 32.0;
    const GBufferImage gbuffer = single_pixel(d, {1 / 64.0F, 1 / 64.0F});
    ScreenRay          ray     = ray_through(0, 0);
    ray.start_pixel            = {3, 0};
    ray.origin_px_depth        = {3.5, 0.5, d + 1 / 64.0};
    ray.delta_px_depth         = {2, 2, 0};
    expect_at(answer(gbuffer, ray, "plane"), TraceStatus::hit, 0.75);
    ray.origin_px_depth.z = std::nextafter(d + 1 / 64.0, 1);
    EXPECT_EQ(answer(gbuffer, ray, "plane").status, TraceStatus::left_screen);
}

TEST(SurfaceModels, SolidReachesFromTheBackToItsFarSide)
{
    constexpr double   d = 1 / 32.0, b = 1 / 64.0;
    const GBufferImage gbuffer = single_pixel(d, {0, 0}, float(b));
    const auto         meets   = [&](double z_in, double z_out, Behind behind = Behind::stop) {
        return answer(gbuffer, ray_through(z_in, z_out), "plane_solid", behind);
    };
    expect_at(meets(0.02, 0.02), TraceStatus::stopped, t_in);          // inside
    expect_at(meets(0.02, 0.02, Behind::hit), TraceStatus::hit, t_in); // as a hit
    EXPECT_EQ(meets(0.02, 0.02, Behind::pass).status, TraceStatus::facing_away);
    expect_at(meets(b, b), TraceStatus::stopped, t_in); // along its far side: equality counts
    EXPECT_EQ(meets(0.015, 0.015).status, TraceStatus::left_screen);
    expect_at(meets(b - 0.001, b + 0.001), TraceStatus::stopped, t_middle); // from behind it
    expect_at(meets(b - 0.001, d + 0.001), TraceStatus::stopped, t_in + (t_out - t_in) * 0.001 / (d - b + 0.002));
    expect_at(meets(d + 0.001, d - 0.001), TraceStatus::hit, t_middle); // the front as ever
    EXPECT_EQ(answer(gbuffer, ray_through(0.02, 0.02), "plane").status, TraceStatus::left_screen);
    GBufferImage unknown = gbuffer;
    unknown.solid_back.clear();
    EXPECT_EQ(answer(unknown, ray_through(0.02, 0.02), "plane_solid").status, TraceStatus::left_screen);
}

/// A solid from depth d to b at the pixel's centre, as two layers of both sides.
GBufferImage front_and_far_side(double d, glm::vec2 gradient, double b, glm::vec2 far_gradient)
{
    GBufferImage gbuffer = single_pixel(d, gradient, float(b));
    gbuffer.layers       = {single_pixel(b, far_gradient)};
    return gbuffer;
}

WalkResult answer_of_sides(const GBufferImage& gbuffer, const ScreenRay& ray)
{
    return ScreenWalk(gbuffer, {.behind = Behind::hit, .surface = "plane_sides", .layers = 2}).walk(ray);
}

TEST(SurfaceModels, SidesOfPlanesAreMetFromOutside)
{
    constexpr double   d = 1 / 32.0, b = 1 / 64.0;
    const GBufferImage solid = front_and_far_side(d, {0, 0}, b, {0, 0});
    const auto meets = [&](double z_in, double z_out) { return answer_of_sides(solid, ray_through(z_in, z_out)); };
    expect_at(meets(d + 0.001, d - 0.001), TraceStatus::hit, t_middle);
    EXPECT_EQ(meets(d + 0.001, d - 0.001).hit_layer, 0);
    expect_at(meets(b - 0.001, b + 0.001), TraceStatus::hit, t_middle);
    EXPECT_EQ(meets(b - 0.001, b + 0.001).hit_layer, 1);
    expect_at(meets(0.02, 0.02), TraceStatus::hit, t_in); // it came in through a side that fills no pixel
    EXPECT_EQ(meets(0.02, 0.02).hit_layer, 0);
    for (const auto& [z_in, z_out] :
         {std::pair(0.02, b - 0.001), {0.02, d + 0.001}, {d + 0.002, d + 0.001}, {0.01, 0.012}})
        EXPECT_EQ(meets(z_in, z_out).status, TraceStatus::left_screen) << z_in << " to " << z_out;
    // Without a far side it is a sheet that both sides stop at, and holds nothing behind it.
    GBufferImage sheet = solid;
    sheet.solid_back.assign(sheet.solid_back.size(), 0);
    expect_at(answer_of_sides(sheet, ray_through(d - 0.001, d + 0.001)), TraceStatus::hit, t_middle);
    EXPECT_EQ(answer_of_sides(sheet, ray_through(0.02, 0.02)).status, TraceStatus::left_screen);
}

// At an outline the planes of both sides bend toward each other, and cross where the solid ends.
TEST(SurfaceModels, SidesOfPlanesEndWhereTheyCross)
{
    constexpr double   d = 1 / 32.0, g = 1 / 512.0, e = 1 / 4096.0, b = d - 2 * e;
    const GBufferImage outline = front_and_far_side(d, {-g, 0}, b, {g, 0});
    const GBufferImage level   = front_and_far_side(d, {0, 0}, b, {0, 0});
    // They cross 1/8 px behind the centre. Until there, a ray of depth d - e is between them.
    expect_at(answer_of_sides(level, ray_through(d - e, d - e)), TraceStatus::hit, t_in);
    EXPECT_EQ(answer_of_sides(outline, ray_through(d - e, d - e)).status, TraceStatus::left_screen);
    // Down through the front before that place, and behind it.
    expect_at(answer_of_sides(outline, ray_through(d + g / 2 + e, d - g / 2 - 5 * e)), TraceStatus::hit,
              t_in + (t_out - t_in) / 6);
    EXPECT_EQ(answer_of_sides(outline, ray_through(d + g / 2 + 5 * e, d - g / 2 - e)).status, TraceStatus::left_screen);
}

TEST(SurfaceModels, PlaneWithoutAnEndHoldsEverythingBehindIt)
{
    constexpr double   d       = 1 / 32.0;
    const GBufferImage gbuffer = single_pixel(d, {0, 0});
    const auto         meets   = [&](double z_in, double z_out, Behind behind = Behind::stop) {
        return answer(gbuffer, ray_through(z_in, z_out), "plane_infinite", behind);
    };
    expect_at(meets(1e-9, 1e-9), TraceStatus::stopped, t_in);
    expect_at(meets(1e-9, d + 0.001), TraceStatus::stopped, t_in);
    expect_at(meets(1e-9, 1e-9, Behind::hit), TraceStatus::hit, t_in);
    EXPECT_EQ(meets(1e-9, 1e-9, Behind::pass).status, TraceStatus::facing_away);
    expect_at(meets(d + 0.001, d - 0.001), TraceStatus::hit, t_middle); // the front as ever
    EXPECT_EQ(meets(d + 0.001, d + 0.001).status, TraceStatus::left_screen);
}

TEST(SurfaceModels, PixelWithoutUsablePlaneHoldsItsBox)
{
    for (const glm::vec2& gradient :
         {glm::vec2(quiet_nan), {quiet_nan, 0}, {0, std::numeric_limits<float>::infinity()}}) {
        const GBufferImage gbuffer = single_pixel(1 / 32.0, gradient, 1 / 64.0F);
        const ScreenRay    in_slab = ray_through(1 / 36.0, 1 / 36.0), in_solid = ray_through(1 / 50.0, 1 / 50.0);
        for (const std::string_view model : {"plane", "plane_solid"})
            expect_at(answer(gbuffer, in_slab, model), TraceStatus::hit, t_in);
        EXPECT_EQ(answer(gbuffer, in_solid, "plane").status, TraceStatus::left_screen);
        expect_at(answer(gbuffer, in_solid, "plane_solid"), TraceStatus::stopped, t_in);
        // Its sides are told apart by height, whatever its normal says.
        GBufferImage facing_away                 = gbuffer;
        facing_away.normal_vs[at(gbuffer, 4, 1)] = {1, 0, 0};
        expect_at(answer(facing_away, in_slab, "plane"), TraceStatus::hit, t_in);
        expect_at(answer(facing_away, in_slab, "box"), TraceStatus::stopped, t_in);
    }
    GBufferImage without = single_pixel(1 / 32.0, {0, 0});
    without.gradient.clear();
    EXPECT_THROW(answer(without, ray_through(0, 0), "plane"), Failure);
    EXPECT_EQ(answer(without, ray_through(1, 1), "box").status, TraceStatus::left_screen);
}

TEST(SurfaceModels, OrthographicToleranceIsOfTheDistance)
{
    // far/(far - near) - depth = 1.25 - 0.5, so the tolerance is 0.75/1024 of depth: 6 m/1024 of 8 m.
    const View         view    = orthographic_view({9, 3});
    const GBufferImage gbuffer = single_pixel(0.5, {0, 0}, 0, view);
    const double       e       = 0.75 / 1024;
    EXPECT_DOUBLE_EQ(plane_tolerance(view, 0.5), e);
    expect_at(answer(gbuffer, ray_through(0.5 - e, 0.5 - e), "plane"), TraceStatus::hit, t_in);
    EXPECT_EQ(answer(gbuffer, ray_through(0.5 - 1.001 * e, 0.5 - 1.001 * e), "plane").status, TraceStatus::left_screen);
}

/// Between a mirror floor at y = -1 and a ceiling at y = 1, 64 x 64 pixels: depth rises by 1/320 a row on both.
GBufferImage floor_and_ceiling()
{
    GBufferImage gbuffer = empty_gbuffer(bench_view({64, 64}));
    gbuffer.gradient.resize(gbuffer.depth.size());
    for (int y = 0; y < 64; ++y) {
        const double row = y + 0.5 - 32;
        for (int x = 0; x < 64; ++x) {
            set_pixel(gbuffer, x, y, 32 / std::abs(row), {0, row > 0 ? 1 : -1, 0}, row > 0 ? 1 : 0);
            gbuffer.gradient[at(gbuffer, x, y)] = {0, float(std::copysign(0.1 / 32, row))};
        }
    }
    return gbuffer;
}

// From the floor at distance Z the ray meets the ceiling at 3 Z: a third as many rows above the horizon as it began below it.
TEST(SurfaceModels, CeilingReflectsWithoutAGap)
{
    const GBufferImage gbuffer = floor_and_ceiling();
    TraceSettings      settings;
    settings.behind         = Behind::stop;
    settings.surface        = "plane";
    const TraceImage planes = screen_truth(gbuffer, settings);
    settings.surface        = "box";
    settings.thickness_m    = 0.1;
    const TraceImage boxes  = screen_truth(gbuffer, settings);
    int              gaps   = 0;
    for (int y = 32; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const size_t i        = at(gbuffer, x, y);
            const double expected = 32 - (y + 0.5 - 32) / 3;
            ASSERT_EQ(planes.status[i], TraceStatus::hit) << x << ' ' << y;
            EXPECT_EQ(planes.hit_pixel[i], glm::ivec2(x, int(expected)));
            EXPECT_NEAR(planes.hit_px_depth[i].y, expected, 1e-3) << y;
            gaps += boxes.status[i] != TraceStatus::hit;
        }
    }
    EXPECT_GT(gaps, 64 * 4); // what the planes mend
}

// A plane does not meet itself, however long it is and however flat the ray.
TEST(SurfaceModels, MirrorFloorDoesNotMeetItself)
{
    for (const glm::ivec2& size : {glm::ivec2(3, 2), {1, 16}, {161, 91}, {320, 180}}) {
        GBufferImage gbuffer = floor_and_wall(bench_view(size), infinity);
        for (size_t i = 0; i < gbuffer.depth.size(); ++i)
            gbuffer.gradient.push_back({0, gbuffer.depth[i] > 0 ? float(0.1 / gbuffer.view.focal_px.y) : quiet_nan});
        for (const Behind behind : {Behind::hit, Behind::stop}) {
            TraceSettings settings;
            settings.surface        = "plane";
            settings.behind         = behind;
            const TraceImage result = screen_truth(gbuffer, settings);
            for (const TraceStatus status : result.status)
                EXPECT_TRUE(status != TraceStatus::hit && status != TraceStatus::stopped);
        }
    }
}

/// A table top at y = 0 from Z = 2 on, over a floor at y = -1, seen level from y = 0.5; from row 32 down every pixel shows the top.
GBufferImage table_over_floor()
{
    const auto level_plane = [](double y_m) {
        GBufferImage gbuffer = empty_gbuffer(bench_view({64, 64}));
        gbuffer.gradient.resize(gbuffer.depth.size());
        for (int y = 32; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                set_pixel(gbuffer, x, y, 32 * -y_m / (y + 0.5 - 32), {0, 1, 0}, 1);
                gbuffer.gradient[at(gbuffer, x, y)] = {0, float(0.1 / (32 * -y_m))};
            }
        return gbuffer;
    };
    GBufferImage gbuffer = level_plane(-0.5);
    gbuffer.layers.push_back(level_plane(-1.5));
    return gbuffer;
}

/// Down a column of the picture, from below the table's top to below the floor: depth over it is that of 1.0 m below the eye, then 2.0 m.
ScreenRay ray_below_the_table(const View& view)
{
    ScreenRay ray;
    ray.traced          = true;
    ray.start_pixel     = {20, 40};
    ray.origin_px_depth = {20.5, 40.5, distance_to_depth(view, 32 * 1.0 / 8.5)};
    ray.delta_px_depth  = glm::dvec3(20.5, 60.5, distance_to_depth(view, 32 * 2.0 / 28.5)) - ray.origin_px_depth;
    ray.end_status      = TraceStatus::left_screen;
    ray.direction_vs    = {0, -1, 0};
    return ray;
}

// With one layer the ray goes on below the table; with two it hits the floor where it crosses its plane.
TEST(Layers, RayBelowATableHitsTheFloor)
{
    const GBufferImage gbuffer = table_over_floor();
    const ScreenRay    ray     = ray_below_the_table(gbuffer.view);
    TraceSettings      settings{.behind = Behind::hit, .surface = "plane"};
    EXPECT_EQ(ScreenWalk(gbuffer, settings).walk(ray).status, TraceStatus::left_screen);
    settings.layers        = 2;
    const WalkResult found = ScreenWalk(gbuffer, settings).walk(ray);
    // Depth of the floor at row r below the horizon is 0.1 r / 48.
    const double over_in  = ray.origin_px_depth.z - 0.1 * 8.5 / 48,
                 over_out = ray.origin_px_depth.z + ray.delta_px_depth.z - 0.1 * 28.5 / 48;
    ASSERT_EQ(found.status, TraceStatus::hit);
    EXPECT_EQ(found.hit_layer, 1);
    EXPECT_NEAR(found.hit_t, over_in / (over_in - over_out), 1e-5);
    settings.layers = 4; // more than there are
    EXPECT_EQ(ScreenWalk(gbuffer, settings).walk(ray).hit_t, found.hit_t);
}

// Of two layers that a ray meets in a pixel the one that it meets first ends it; at the same t the one in front.
TEST(Layers, TheFirstContactEndsTheRay)
{
    GBufferImage        gbuffer = table_over_floor();
    const ScreenRay     ray     = ray_below_the_table(gbuffer.view);
    const TraceSettings settings{.behind = Behind::hit, .surface = "plane", .layers = 2};
    gbuffer.layers[0].layers = {};
    const WalkResult floor   = ScreenWalk(gbuffer, settings).walk(ray);
    // The same floor as a third layer, a little higher: the ray crosses it earlier in the same pixel.
    GBufferImage higher = gbuffer.layers[0];
    for (float& depth : higher.depth) depth *= 1.001F;
    TraceSettings three = settings;
    three.layers        = 3;
    gbuffer.layers.push_back(higher);
    const WalkResult first = ScreenWalk(gbuffer, three).walk(ray);
    EXPECT_EQ(first.hit_layer, 2);
    EXPECT_LT(first.hit_t, floor.hit_t);
    gbuffer.layers[1]    = gbuffer.layers[0];
    const WalkResult tie = ScreenWalk(gbuffer, three).walk(ray);
    EXPECT_EQ(tie.hit_layer, 1);
    EXPECT_EQ(tie.hit_t, floor.hit_t);
}

using Real = long double;
struct Range {
    Real from = 0, to = 0;
    bool empty() const { return !(from <= to); }
};

/// The part of `t` where a + t * b lies in [low, high].
Range where_between(Range t, Real a, Real b, Real low, Real high)
{
    if (b == 0) return a >= low && a <= high ? t : Range{1, 0};
    const Real s = (low - a) / b, u = (high - a) / b;
    return {std::max(t.from, std::min(s, u)), std::min(t.to, std::max(s, u))};
}

/// As a set of points: between front and back, or below the back and not farther than the solid's far side.
WalkResult first_by_sets(const GBufferImage& gbuffer, const ScreenRay& ray, const TraceSettings& settings)
{
    constexpr Real big = 1e30L;
    WalkResult     best;
    best.status = ray.end_status;
    Real first = 2, passed = 0;
    for (size_t i = 0; i < gbuffer.depth.size(); ++i) {
        const auto       surface = pixel_surface(gbuffer, 0, i, settings);
        const glm::ivec2 pixel   = pixel_at(i, gbuffer.view.size_px);
        if (!surface || pixel == ray.start_pixel) continue;
        Range inside{0, 1};
        for (int axis : {0, 1})
            inside = where_between(inside, ray.origin_px_depth[axis], ray.delta_px_depth[axis], pixel[axis],
                                   pixel[axis] + 1);
        if (inside.empty() || inside.to - inside.from < 1e-15L || inside.from >= first) continue;
        const Real z = ray.origin_px_depth.z, dz = ray.delta_px_depth.z;
        Real       over = z - Real(surface->front_at(glm::dvec2(ray.origin_px_depth))), rate = dz;
        for (int axis : {0, 1}) rate -= Real(surface->gradient[axis]) * Real(ray.delta_px_depth[axis]);
        if (std::isinf(surface->front)) over = -big / 2;
        const Real  depth   = std::isinf(surface->front) || std::isinf(surface->back)
                                  ? (std::isinf(surface->back) ? big : big / 2 - z + surface->back)
                                  : Real(surface->front) - Real(surface->back);
        const bool  endless = std::isinf(surface->front);
        const Range sheet =
            endless ? where_between(inside, z, dz, surface->back, big) : where_between(inside, over, rate, -depth, 0);
        Range solid{1, 0};
        if (surface->solid_back < big)
            solid = where_between(where_between(inside, over, rate, -big, -depth), z, dz,
                                  std::max(Real(surface->solid_back), -big), big);
        if (sheet.empty() && solid.empty()) continue;
        const bool below  = !endless && over + inside.from * rate < -depth;
        const bool normal = glm::dot(glm::dvec3(gbuffer.normal_vs[i]), ray.direction_vs) < 0;
        const bool behind = surface->sides_by_height ? below : (sheet.empty() || !normal);
        if (behind && settings.behind == Behind::pass) {
            passed = 1;
            continue;
        }
        first          = inside.from;
        best.hit_t     = double(std::min(sheet.empty() ? Real(2) : sheet.from, solid.empty() ? Real(2) : solid.from));
        best.hit_pixel = pixel;
        best.status    = behind && settings.behind == Behind::stop ? TraceStatus::stopped : TraceStatus::hit;
    }
    if (first == 2 && passed != 0) best.status = TraceStatus::facing_away;
    return best;
}

GBufferImage random_planes(const View& view, unsigned seed)
{
    GBufferImage                          gbuffer = random_gbuffer(view, seed);
    std::mt19937                          random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (const float depth : gbuffer.depth) {
        const float steep = 0.5F * unit(random) * unit(random);
        gbuffer.gradient.push_back(depth * steep * glm::vec2(unit(random), unit(random)));
        if (unit(random) > 0.8F) gbuffer.gradient.back().x = quiet_nan;
        gbuffer.solid_back.push_back(unit(random) > 0 ? depth * (0.7F + 0.29F * unit(random)) : 0);
    }
    return gbuffer;
}

/// Which statuses occurred; every ray of the picture compared with the definition by sets.
std::array<int, 8> compare_with_sets(const GBufferImage& gbuffer, const TraceSettings& settings)
{
    const TraceImage   result = screen_truth(gbuffer, settings);
    std::array<int, 8> seen{};
    for (size_t i = 0; i < gbuffer.depth.size(); ++i) {
        const ScreenRay ray = make_screen_ray(gbuffer, pixel_at(i, gbuffer.view.size_px), settings);
        if (!ray.traced) continue;
        const WalkResult expected = first_by_sets(gbuffer, ray, settings);
        ++seen[size_t(result.status[i])];
        EXPECT_EQ(result.status[i], expected.status) << i;
        if (expected.status != TraceStatus::hit && expected.status != TraceStatus::stopped) continue;
        EXPECT_EQ(result.hit_pixel[i], expected.hit_pixel) << i;
        EXPECT_NEAR(result.hit_t[i], expected.hit_t, 1e-9) << i;
        const glm::dvec2 in_pixel = glm::dvec2(result.hit_px_depth[i]) - glm::dvec2(result.hit_pixel[i]);
        EXPECT_TRUE(glm::all(glm::equal(in_pixel, glm::clamp(in_pixel, 0.0, 1.0)))) << i;
    }
    return seen;
}

TEST(SurfaceModels, EqualTheirDefinitionAsSetsOfPoints)
{
    for (const View& view : {bench_view({41, 37}), orthographic_view({41, 37})}) {
        const GBufferImage gbuffer = random_planes(view, 7);
        for (const std::string_view surface : all_models) {
            for (const Behind behind : {Behind::hit, Behind::pass, Behind::stop}) {
                TraceSettings settings;
                settings.surface              = surface;
                settings.behind               = behind;
                const std::array<int, 8> seen = compare_with_sets(gbuffer, settings);
                EXPECT_GT(seen[size_t(TraceStatus::hit)], 100) << surface;
                EXPECT_EQ(seen[size_t(TraceStatus::stopped)] > 20, behind == Behind::stop) << surface;
                EXPECT_EQ(seen[size_t(TraceStatus::facing_away)] > 0, behind == Behind::pass) << surface;
            }
        }
        const auto seen = compare_with_sets(gbuffer, boxes({.thickness_relative = true, .ray_offset_m = 0.3}));
        EXPECT_GT(seen[size_t(TraceStatus::hit)], 300);
    }
}

} // namespace
} // namespace ssrlab
