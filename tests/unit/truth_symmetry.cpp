// The screen truth against a second definition of itself, and its symmetries.
#include "truth/screen_truth.h"
#include "truth_gbuffers.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ssrlab {
namespace {

using namespace test;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The first pixel by definition: every pixel of the image clipped against the ray, in long double.
WalkResult brute_force(const GBufferImage& gbuffer, const ScreenRay& ray, const TraceSettings& settings)
{
    using Real = long double;
    WalkResult best;
    best.status = ray.end_status;
    Real first  = 2;
    for (int y = 0; y < gbuffer.view.size_px.y; ++y) {
        for (int x = 0; x < gbuffer.view.size_px.x; ++x) {
            const double depth = gbuffer.depth[at(gbuffer, x, y)];
            if (depth <= 0 || glm::ivec2(x, y) == ray.start_pixel) continue;
            Real low = 0, high = 1;
            for (int axis : {0, 1}) {
                const Real o = ray.origin_px_depth[axis], d = ray.delta_px_depth[axis];
                const Real a = ((axis == 0 ? x : y) - o) / d, b = ((axis == 0 ? x : y) + 1 - o) / d;
                low  = std::max(low, std::min(a, b));
                high = std::min(high, std::max(a, b));
            }
            if (high - low < 1e-15L) continue;
            const Real za = ray.origin_px_depth.z + low * ray.delta_px_depth.z;
            const Real zb = ray.origin_px_depth.z + high * ray.delta_px_depth.z;
            if (std::min(za, zb) > depth || std::max(za, zb) < slab_back(gbuffer.view, depth, settings)) continue;
            if (low < first) {
                first          = low;
                best.status    = TraceStatus::hit;
                best.hit_pixel = {x, y};
            }
        }
    }
    return best;
}

TEST(ScreenTruth, EqualsBruteForceOverAllPixels)
{
    View orthographic       = bench_view({41, 37});
    orthographic.projection = Projection::orthographic;
    orthographic.focal_px   = {5, 5};
    orthographic.far_m      = 10;
    TraceSettings offset;
    offset.ray_offset_m       = 0.3;
    offset.thickness_relative = true;
    for (const View& view : {bench_view({41, 37}), orthographic}) {
        for (const TraceSettings& settings : {TraceSettings{}, offset}) {
            const GBufferImage gbuffer = random_gbuffer(view, 7);
            const TraceResult  result  = screen_truth(gbuffer, settings);
            int                hits    = 0;
            for (int y = 0; y < 37; ++y) {
                for (int x = 0; x < 41; ++x) {
                    const size_t    i   = at(gbuffer, x, y);
                    const ScreenRay ray = make_screen_ray(gbuffer, {x, y}, settings);
                    if (!ray.traced) continue;
                    const WalkResult expected = brute_force(gbuffer, ray, settings);
                    ASSERT_EQ(result.status[i], expected.status) << x << ' ' << y;
                    if (expected.status != TraceStatus::hit) continue;
                    ++hits;
                    EXPECT_EQ(result.hit_pixel[i], expected.hit_pixel) << x << ' ' << y;
                    const glm::dvec2 low(result.hit_pixel[i]);
                    EXPECT_TRUE(glm::all(glm::lessThanEqual(low, glm::dvec2(result.hit_px_depth[i]))) &&
                                glm::all(glm::lessThanEqual(glm::dvec2(result.hit_px_depth[i]), low + 1.0)));
                }
            }
            EXPECT_GT(hits, 300);
        }
    }
}

void expect_same_rays(const TraceResult& a, size_t i, const TraceResult& b, size_t j, glm::ivec2 expected_pixel)
{
    ASSERT_EQ(a.status[i], b.status[j]);
    ASSERT_EQ(a.steps[i], b.steps[j]);
    if (a.status[i] != TraceStatus::hit) return;
    EXPECT_EQ(b.hit_pixel[j], expected_pixel);
    EXPECT_EQ(a.hit_t[i], b.hit_t[j]);
    EXPECT_EQ(a.hit_px_depth[i].z, b.hit_px_depth[j].z);
}

View off_centre_view()
{
    View view      = bench_view({53, 39});
    view.centre_px = {20.25, 17.5};
    return view;
}

TEST(ScreenTruth, MirroredImageGivesMirroredResult)
{
    const GBufferImage gbuffer  = random_gbuffer(off_centre_view(), 3);
    GBufferImage       mirrored = gbuffer;
    mirrored.view.centre_px.x   = 53 - gbuffer.view.centre_px.x;
    for (int y = 0; y < 39; ++y) {
        for (int x = 0; x < 53; ++x) {
            mirrored.depth[at(mirrored, 52 - x, y)]     = gbuffer.depth[at(gbuffer, x, y)];
            mirrored.metallic[at(mirrored, 52 - x, y)]  = gbuffer.metallic[at(gbuffer, x, y)];
            mirrored.normal_vs[at(mirrored, 52 - x, y)] = gbuffer.normal_vs[at(gbuffer, x, y)] * glm::vec3(-1, 1, 1);
        }
    }
    const TraceResult a = screen_truth(gbuffer, {}), b = screen_truth(mirrored, {});
    for (int y = 0; y < 39; ++y) {
        for (int x = 0; x < 53; ++x) {
            const glm::ivec2 hit = a.hit_pixel[at(gbuffer, x, y)];
            expect_same_rays(a, at(gbuffer, x, y), b, at(mirrored, 52 - x, y), {52 - hit.x, hit.y});
        }
    }
}

TEST(ScreenTruth, TransposedImageGivesTransposedResult)
{
    const GBufferImage gbuffer = random_gbuffer(off_centre_view(), 4);
    View               view    = gbuffer.view;
    std::swap(view.size_px.x, view.size_px.y);
    std::swap(view.centre_px.x, view.centre_px.y);
    GBufferImage transposed = empty_gbuffer(view);
    for (int y = 0; y < 39; ++y) {
        for (int x = 0; x < 53; ++x) {
            const glm::vec3 n                          = gbuffer.normal_vs[at(gbuffer, x, y)];
            transposed.depth[at(transposed, y, x)]     = gbuffer.depth[at(gbuffer, x, y)];
            transposed.metallic[at(transposed, y, x)]  = gbuffer.metallic[at(gbuffer, x, y)];
            transposed.normal_vs[at(transposed, y, x)] = {-n.y, -n.x, n.z}; // y points up in view space, down on screen
        }
    }
    const TraceResult a = screen_truth(gbuffer, {}), b = screen_truth(transposed, {});
    for (int y = 0; y < 39; ++y) {
        for (int x = 0; x < 53; ++x) {
            const glm::ivec2 hit = a.hit_pixel[at(gbuffer, x, y)];
            expect_same_rays(a, at(gbuffer, x, y), b, at(transposed, y, x), {hit.y, hit.x});
        }
    }
}

// No absolute epsilon anywhere: all lengths times a power of two changes no bit.
TEST(ScreenTruth, ScaledByPowerOfTwoIsBitIdentical)
{
    const GBufferImage gbuffer = random_gbuffer(off_centre_view(), 5);
    TraceSettings      settings;
    settings.max_distance_m = 3;
    settings.ray_offset_m   = 0.01;
    const TraceResult a     = screen_truth(gbuffer, settings);
    for (const int power : {-13, 1, 20}) {
        GBufferImage  scaled          = gbuffer;
        TraceSettings scaled_settings = settings;
        scaled.view.near_m            = std::ldexp(gbuffer.view.near_m, power);
        for (double* length :
             {&scaled_settings.max_distance_m, &scaled_settings.ray_offset_m, &scaled_settings.thickness_m}) {
            *length = std::ldexp(*length, power);
        }
        const TraceResult b = screen_truth(scaled, scaled_settings);
        for (size_t i = 0; i < a.status.size(); ++i) {
            expect_same_rays(a, i, b, i, a.hit_pixel[i]);
            if (a.status[i] == TraceStatus::hit) {
                EXPECT_EQ(a.hit_px_depth[i], b.hit_px_depth[i]);
            }
        }
    }
}

TEST(ScreenTruth, ThreadsDoNotMatter)
{
    const GBufferImage gbuffer = random_gbuffer(bench_view({67, 45}), 9);
    const TraceResult  a = screen_truth(gbuffer, {}, 1), b = screen_truth(gbuffer, {}, 3);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.hit_t, b.hit_t);
    EXPECT_EQ(a.steps, b.steps);
}

// A thicker slab can only end a ray earlier, never later.
TEST(ScreenTruth, ThicknessIsMonotone)
{
    const GBufferImage gbuffer  = random_gbuffer(bench_view({53, 39}), 11);
    double             last_sum = infinity;
    for (const double thickness_m : {0.0, 0.05, 0.5, 5.0, infinity}) {
        TraceSettings settings;
        settings.thickness_m     = thickness_m;
        const TraceResult result = screen_truth(gbuffer, settings);
        double            sum    = 0;
        for (size_t i = 0; i < result.status.size(); ++i)
            sum += result.status[i] == TraceStatus::hit ? result.hit_t[i] : 1.0;
        EXPECT_LE(sum, last_sum);
        last_sum = sum;
    }
}

} // namespace
} // namespace ssrlab
