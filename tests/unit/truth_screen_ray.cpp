// The ray set-up at the 64 x 64 bench camera, where every end point has a closed form.
#include "core/error.h"
#include "truth/screen_ray.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One reflecting pixel that sends its ray along `direction_vs`.
GBufferImage pixel_towards(glm::ivec2 pixel, double distance_m, glm::dvec3 direction_vs)
{
    GBufferImage     gbuffer  = empty_gbuffer(bench_view({64, 64}));
    const glm::dvec3 to_point = glm::normalize(px_to_vs(gbuffer.view, glm::dvec2(pixel) + 0.5, 0.01));
    set_pixel(gbuffer, pixel.x, pixel.y, distance_m, glm::normalize(glm::normalize(direction_vs) - to_point), 1);
    return gbuffer;
}

ScreenRay ray_of(const GBufferImage& gbuffer, glm::ivec2 pixel, double max_distance_m, double offset_m = 0)
{
    TraceSettings settings;
    settings.max_distance_m = max_distance_m;
    settings.ray_offset_m   = offset_m;
    return make_screen_ray(gbuffer, pixel, settings);
}

void expect_identical(const ScreenRay& a, const ScreenRay& b)
{
    EXPECT_EQ(a.origin_px_depth, b.origin_px_depth);
    EXPECT_EQ(a.delta_px_depth, b.delta_px_depth);
    EXPECT_EQ(a.end_status, b.end_status);
    EXPECT_EQ(a.length_m, b.length_m);
}

// A mirror across the view axis at Z = 10: the direction (X, Y, +Z) leaves the right border (X = Z) at Z = 10 (1 - s) with
// s = (1 - a) / (1 + a), a = 16.5 / 32.
TEST(ScreenRay, TowardsTheCameraLeavesAtTheBorder)
{
    GBufferImage gbuffer = empty_gbuffer(bench_view({64, 64}));
    set_pixel(gbuffer, 48, 32, 10, {0, 0, 1}, 1);
    const ScreenRay  ray = ray_of(gbuffer, {48, 32}, infinity);
    const glm::dvec3 end = ray.origin_px_depth + ray.delta_px_depth;
    EXPECT_EQ(ray.end_status, TraceStatus::left_screen);
    EXPECT_EQ(end.x, 64);
    EXPECT_NEAR(end.y, 32.969697, 1e-6);
    EXPECT_NEAR(0.1 / end.z, 6.8041237, 1e-6);
}

TEST(ScreenRay, NearPlaneEndsItWhateverTheMaximumDistance)
{
    const GBufferImage gbuffer = pixel_towards({31, 31}, 2, {0, 0.01, 1});
    const ScreenRay    ray     = ray_of(gbuffer, {31, 31}, 2);
    EXPECT_EQ(ray.end_status, TraceStatus::left_screen);
    EXPECT_NEAR(ray.length_m, 1.9 * std::sqrt(1.0001), 1e-5);
    EXPECT_NEAR(ray.origin_px_depth.z + ray.delta_px_depth.z, 1, 1e-12);
    for (const double max_distance_m : {1.91, 10.0, 1e6, double(std::numeric_limits<float>::max()), infinity}) {
        expect_identical(ray, ray_of(gbuffer, {31, 31}, max_distance_m));
    }
    const ScreenRay shorter = ray_of(gbuffer, {31, 31}, 1.5);
    EXPECT_EQ(shorter.end_status, TraceStatus::past_max_distance);
    EXPECT_EQ(shorter.length_m, 1.5);
}

TEST(ScreenRay, InfinityIsTheVanishingPoint)
{
    const GBufferImage gbuffer = pixel_towards({32, 48}, 2, {0.3, 0.2, -0.93273791});
    glm::dvec3         last{0};
    for (const double max_distance_m : {1e9, 1e30, 1e300, infinity}) {
        const ScreenRay ray = ray_of(gbuffer, {32, 48}, max_distance_m);
        last                = ray.origin_px_depth + ray.delta_px_depth;
        EXPECT_EQ(ray.end_status, TraceStatus::past_max_distance);
        EXPECT_NEAR(last.x, 42.292280, 1e-5);
        EXPECT_NEAR(last.y, 25.138480, 1e-5);
        EXPECT_NEAR(last.z, 0, 2e-10);
    }
}

TEST(ScreenRay, ParallelToTheImageKeepsItsDepth)
{
    const GBufferImage gbuffer = pixel_towards({48, 20}, 5, {-1, 0, 0});
    const ScreenRay    ray     = ray_of(gbuffer, {48, 20}, infinity);
    EXPECT_EQ(ray.origin_px_depth.x + ray.delta_px_depth.x, 0);
    EXPECT_NEAR(ray.delta_px_depth.y, 0, 1e-5);
    EXPECT_NEAR(ray.delta_px_depth.z, 0, 1e-7);
    EXPECT_EQ(ray.end_status, TraceStatus::left_screen);
}

TEST(ScreenRay, ScaledAndFlippedNormalsGiveTheSameRay)
{
    GBufferImage    gbuffer = pixel_towards({12, 50}, 3, {0.2, 0.5, -0.4});
    const ScreenRay ray     = ray_of(gbuffer, {12, 50}, 100);
    const glm::vec3 normal  = gbuffer.normal_vs[at(gbuffer, 12, 50)];
    for (const float scale : {0.5F, 4.0F, -1.0F, std::ldexp(1.0F, 100), std::ldexp(1.0F, -90)}) {
        gbuffer.normal_vs[at(gbuffer, 12, 50)] = normal * scale;
        expect_identical(ray, ray_of(gbuffer, {12, 50}, 100));
    }
}

TEST(ScreenRay, OffsetMovesTheStart)
{
    const GBufferImage gbuffer = pixel_towards({32, 48}, 2, {0.3, 0.2, -0.93273791});
    const ScreenRay    plain   = ray_of(gbuffer, {32, 48}, 10);
    const ScreenRay    moved   = ray_of(gbuffer, {32, 48}, 10, 1);
    const glm::dvec3   end     = plain.origin_px_depth + plain.delta_px_depth;
    const glm::dvec3   start   = vs_to_px(gbuffer.view, pixel_point_vs(gbuffer, {32, 48}) + plain.direction_vs);
    EXPECT_EQ(moved.start_pixel, glm::ivec2(glm::floor(glm::dvec2(start))));
    for (int i : {0, 1, 2}) {
        EXPECT_NEAR(moved.origin_px_depth[i], start[i], 1e-12);
        EXPECT_NEAR(moved.origin_px_depth[i] + moved.delta_px_depth[i], end[i], 1e-11);
    }
    const ScreenRay beyond = ray_of(gbuffer, {32, 48}, 10, 10);
    EXPECT_EQ(beyond.delta_px_depth, glm::dvec3(0));
    EXPECT_EQ(beyond.end_status, TraceStatus::past_max_distance);
}

TEST(ScreenRay, MaximumDistanceZeroVisitsNothing)
{
    const ScreenRay ray = ray_of(pixel_towards({32, 48}, 2, {0.3, 0.2, -0.9}), {32, 48}, 0);
    EXPECT_EQ(ray.delta_px_depth, glm::dvec3(0));
    EXPECT_EQ(ray.end_status, TraceStatus::past_max_distance);
}

TEST(ScreenRay, EveryEndLiesInTheImage)
{
    size_t far_ends = 0, border_ends = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        View view = bench_view({31, 23});
        if (seed % 2 == 1) {
            view.projection = Projection::orthographic;
            view.focal_px   = {3, 3};
            view.far_m      = 10;
        }
        view.centre_px += glm::dvec2(0.37, -5.1) * double(seed);
        const GBufferImage gbuffer = random_gbuffer(view, seed);
        for (const auto [i, x, y] : pixels_of({31, 23})) {
            const ScreenRay ray = ray_of(gbuffer, {x, y}, seed % 3 == 0 ? infinity : 2.5);
            if (!ray.traced) continue;
            const glm::dvec3 end = ray.origin_px_depth + ray.delta_px_depth;
            ASSERT_TRUE(end.x >= 0 && end.x <= 31 && end.y >= 0 && end.y <= 23) << seed << ' ' << x << ' ' << y;
            ASSERT_TRUE(std::isfinite(end.z) && end.z <= 1 + 1e-12);
            const bool at_border = end.x == 0 || end.x == 31 || end.y == 0 || end.y == 23, at_near = end.z > 1 - 1e-12;
            const bool at_end = at_border || at_near || ray.end_status != TraceStatus::left_screen;
            ASSERT_TRUE(at_end) << seed << ' ' << x << ' ' << y;
            const bool at_far = view.projection == Projection::orthographic && std::abs(end.z) < 1e-12;
            ASSERT_TRUE(!at_far || ray.end_status == TraceStatus::past_max_distance);
            far_ends += at_far;
            border_ends += at_border;
        }
    }
    EXPECT_GT(far_ends, 10U);
    EXPECT_GT(border_ends, 1000U);
}

// Both borders of a corner are met at once but for rounding, so that the end on one of them must be put into the image.
TEST(ScreenRay, EndsInCornersLieInTheImage)
{
    const GBufferImage gbuffer = floor_and_wall(bench_view({61, 47}), infinity);
    TraceSettings      settings;
    settings.max_distance_m = infinity;
    size_t in_corner        = 0;
    for (int y = 24; y < 47; ++y)
        for (int x = 0; x < 61; ++x)
            for (const glm::dvec2& corner :
                 {glm::dvec2(0, 0), glm::dvec2(61, 0), glm::dvec2(0, 47), glm::dvec2(61, 47)}) {
                const glm::dvec2 way = (corner - (glm::dvec2(x, y) + 0.5)) / gbuffer.view.focal_px;
                const ScreenRay  ray = make_screen_ray(gbuffer, {x, y}, {way.x, -way.y, 0}, settings);
                const glm::dvec2 end(ray.origin_px_depth + ray.delta_px_depth);
                ASSERT_TRUE(end.x >= 0 && end.x <= 61 && end.y >= 0 && end.y <= 47) << x << ' ' << y;
                ASSERT_LT(glm::distance(end, corner), 1e-9);
                in_corner += end == corner;
            }
    EXPECT_GT(in_corner, 1000U);
}

TEST(ScreenRay, AMaterialReflectsByItsMetalOrItsSmoothCoat)
{
    TraceSettings settings;
    settings.dielectric_min_f0        = 0.04;
    settings.dielectric_max_roughness = 0.4;
    GBufferImage gbuffer              = pixel_towards({12, 50}, 3, {0.2, 0.5, -0.4});
    const size_t i                    = at(gbuffer, 12, 50);
    const auto   reflecting           = [&](float metallic, float f0, float roughness) {
        gbuffer.metallic[i] = metallic, gbuffer.dielectric_f0[i] = f0, gbuffer.roughness[i] = roughness;
        return reflects(gbuffer, {12, 50}, settings);
    };
    EXPECT_TRUE(reflecting(0.01F, 0, 1));
    EXPECT_TRUE(reflecting(0, 0.04F, 0.4F));
    EXPECT_FALSE(reflecting(0, 0.04F, 0.41F));
    EXPECT_FALSE(reflecting(0, 0.039F, 0));
    EXPECT_FALSE(reflecting(0, 0.04F, 1));
    gbuffer.roughness.clear();
    EXPECT_TRUE(reflects(gbuffer, {12, 50}, settings)) << "without a roughness all is smooth";
    for (const float depth : {0.0F, -1.0F, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        gbuffer.depth[i] = depth;
        EXPECT_FALSE(reflects(gbuffer, {12, 50}, settings)) << depth;
    }
    gbuffer.depth[i]     = 0.1F;
    gbuffer.normal_vs[i] = glm::vec3(0);
    EXPECT_FALSE(reflects(gbuffer, {12, 50}, settings));
    gbuffer.normal_vs[i] = {0, std::nanf(""), 1};
    EXPECT_FALSE(reflects(gbuffer, {12, 50}, settings));
}

TEST(ScreenRay, IncompleteGBufferIsRefused)
{
    GBufferImage gbuffer = empty_gbuffer(bench_view({4, 4}));
    gbuffer.metallic.pop_back();
    EXPECT_THROW(require_complete(gbuffer), Failure);
}

} // namespace
} // namespace ssrlab
