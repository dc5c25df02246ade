// Symmetries of the screen truth.
#include "truth/screen_truth.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr double infinity = std::numeric_limits<double>::infinity();

void expect_same_rays(const TraceImage& a, size_t i, const TraceImage& b, size_t j, glm::ivec2 expected_pixel)
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
    for (const auto [i, x, y] : pixels_of({53, 39})) {
        mirrored.depth[at(mirrored, 52 - x, y)]     = gbuffer.depth[at(gbuffer, x, y)];
        mirrored.metallic[at(mirrored, 52 - x, y)]  = gbuffer.metallic[at(gbuffer, x, y)];
        mirrored.normal_vs[at(mirrored, 52 - x, y)] = gbuffer.normal_vs[at(gbuffer, x, y)] * glm::vec3(-1, 1, 1);
    }
    const TraceImage a = screen_truth(gbuffer, boxes()), b = screen_truth(mirrored, boxes());
    for (const auto [i, x, y] : pixels_of({53, 39})) {
        const glm::ivec2 hit = a.hit_pixel[at(gbuffer, x, y)];
        expect_same_rays(a, at(gbuffer, x, y), b, at(mirrored, 52 - x, y), {52 - hit.x, hit.y});
    }
}

TEST(ScreenTruth, TransposedImageGivesTransposedResult)
{
    const GBufferImage gbuffer = random_gbuffer(off_centre_view(), 4);
    View               view    = gbuffer.view;
    std::swap(view.size_px.x, view.size_px.y);
    std::swap(view.centre_px.x, view.centre_px.y);
    GBufferImage transposed = empty_gbuffer(view);
    for (const auto [i, x, y] : pixels_of({53, 39})) {
        const glm::vec3 n                          = gbuffer.normal_vs[at(gbuffer, x, y)];
        transposed.depth[at(transposed, y, x)]     = gbuffer.depth[at(gbuffer, x, y)];
        transposed.metallic[at(transposed, y, x)]  = gbuffer.metallic[at(gbuffer, x, y)];
        transposed.normal_vs[at(transposed, y, x)] = {-n.y, -n.x, n.z}; // y points up in view space, down on screen
    }
    const TraceImage a = screen_truth(gbuffer, boxes()), b = screen_truth(transposed, boxes());
    for (const auto [i, x, y] : pixels_of({53, 39})) {
        const glm::ivec2 hit = a.hit_pixel[at(gbuffer, x, y)];
        expect_same_rays(a, at(gbuffer, x, y), b, at(transposed, y, x), {hit.y, hit.x});
    }
}

// No absolute epsilon anywhere: all lengths times a power of two changes no bit.
TEST(ScreenTruth, ScaledByPowerOfTwoIsBitIdentical)
{
    const GBufferImage gbuffer  = random_gbuffer(off_centre_view(), 5);
    TraceSettings      settings = boxes();
    settings.max_distance_m     = 3;
    settings.ray_offset_m       = 0.01;
    const TraceImage a          = screen_truth(gbuffer, settings);
    for (const int power : {-13, 1, 20}) {
        GBufferImage  scaled          = gbuffer;
        TraceSettings scaled_settings = settings;
        scaled.view.near_m            = std::ldexp(gbuffer.view.near_m, power);
        for (double* length :
             {&scaled_settings.max_distance_m, &scaled_settings.ray_offset_m, &scaled_settings.thickness_m}) {
            *length = std::ldexp(*length, power);
        }
        const TraceImage b = screen_truth(scaled, scaled_settings);
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
    const TraceImage   a = screen_truth(gbuffer, boxes(), 1), b = screen_truth(gbuffer, boxes(), 3);
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
        TraceSettings settings  = boxes();
        settings.thickness_m    = thickness_m;
        const TraceImage result = screen_truth(gbuffer, settings);
        double           sum    = 0;
        for (size_t i = 0; i < result.status.size(); ++i)
            sum += result.status[i] == TraceStatus::hit ? result.hit_t[i] : 1.0;
        EXPECT_LE(sum, last_sum);
        last_sum = sum;
    }
}

} // namespace
} // namespace ssrlab
