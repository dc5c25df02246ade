// Techniques that stride over pixels, on pictures whose answers are known.
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr int              first_floor_row = 44, last_floor_row = 63;
const TraceSettings        thin      = boxes({.thickness_m = 0.5, .max_distance_m = 20});
const TraceSettings        unlimited = boxes({.thickness_m = infinity, .max_distance_m = 1e4});
constexpr std::string_view both[]    = {"dda_strided", "strided_direction"};

/// 64 x 64, floor before a wall at 3 m: floor row y shows the wall straight above. A ray is behind the wall for at least 18 px.
double wall_px(int y) { return 64 + 64.0 / 3 - (y + 0.5); }

GBufferImage wall_picture() { return floor_and_wall(bench_view({64, 64}), 3); }

TraceImage trace_with(const GBufferImage& image, std::string_view id, const ParameterValues& changed,
                      const TraceSettings& settings)
{
    const Technique& t = technique(std::string(id));
    return trace(make_picture(image), t, values_of(t, changed), settings);
}

/// How far on screen the hits of the floor's rays lie from where the wall is met, at least `nearest_px` away; every ray must hit.
std::vector<double> errors_px(const TraceImage& result, double nearest_px = 0)
{
    std::vector<double> errors;
    for (int y = first_floor_row; y <= last_floor_row; ++y) {
        if (y + 0.5 - wall_px(y) < nearest_px) continue;
        for (int x = 0; x < 64; ++x) {
            const auto i = pixel_index({x, y}, result.size_px);
            EXPECT_EQ(result.status[i], TraceStatus::hit) << x << ", " << y;
            if (result.status[i] == TraceStatus::hit) errors.push_back(std::abs(result.hit_px_depth[i].y - wall_px(y)));
        }
    }
    return errors;
}

double largest(const std::vector<double>& values) { return values.empty() ? infinity : std::ranges::max(values); }

double mean(const std::vector<double>& values)
{
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

// Behind the first sample, which is up to two strides away. Depth between the samples is linear in 1/z: were it linear in z, the rays would meet the wall many pixels off.
TEST(DdaStrided, FindsTheWallWithinHalfAStride)
{
    for (const double stride : {1.0, 2.0, 4.0, 8.0})
        for (const double jitter : {0.0, 1.0}) {
            const TraceImage result =
                trace_with(wall_picture(), "dda_strided", {{"stride_px", stride}, {"jitter", jitter}}, thin);
            EXPECT_LE(largest(errors_px(result, 2.5 * stride)), 0.5 * stride + 1e-3) << stride << ", jitter " << jitter;
        }
}

TEST(DdaStrided, IsThePixelWalkAlongColumnsAtStrideOne)
{
    const TraceImage walk   = trace_with(wall_picture(), "dda", {}, thin),
                     result = trace_with(wall_picture(), "dda_strided", {{"stride_px", 1}, {"jitter", 0}}, thin);
    std::string first;
    EXPECT_EQ(count_differences(result, walk, any_t, first), 0U) << first;
}

// A ray lies on its own plane where it begins: a step that began there would meet the floor in every next pixel.
TEST(Strides, OverPlanesAFloorIsNotItsOwnReflection)
{
    TraceSettings planes = thin;
    planes.surface       = "plane";
    planes.behind        = Behind::stop;
    const auto tried     = [&](std::string_view id, const ParameterValues& values) {
        const TraceImage result = trace_with(wall_picture(), id, values, planes);
        size_t           hits   = 0;
        for (int y = first_floor_row; y <= last_floor_row; ++y)
            for (int x = 0; x < 64; ++x) {
                const size_t i = pixel_index({x, y}, result.size_px);
                if (!has_place(result.status[i])) continue;
                EXPECT_LT(result.hit_pixel[i].y, first_floor_row) << id << ", ray of " << x << ", " << y;
                ++hits;
            }
        EXPECT_GT(hits, 600U) << id; // the wall
    };
    tried("dda_strided", {{"stride_px", 1}, {"jitter", 0}});
    tried("dda_strided", {{"stride_px", 3}, {"jitter", 1}});
    tried("linear", {{"space", 2}, {"interval", 1}});
    tried("linear", {{"space", 1}, {"interval", 1}});
}

// A bar one pixel high: stride 8 finds it from every eighth row; shifted, its samples find it from every eighth pixel.
TEST(DdaStrided, StepsOverABarAsOftenAsItsStrideSays)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), infinity);
    for (int x = 0; x < 64; ++x) set_pixel(image, x, 20, 5, {0, 0, 1}, 0);
    for (const double jitter : {0.0, 1.0}) {
        const TraceImage result = trace_with(image, "dda_strided", {{"stride_px", 8}, {"jitter", jitter}}, unlimited);
        size_t           rays = 0, hits = 0;
        // The rays of these rows are more than 5 m deep there.
        for (size_t i = 48 * 64; i < 56 * 64; ++i) {
            ++rays;
            if (result.status[i] != TraceStatus::hit) continue;
            ++hits;
            EXPECT_EQ(result.hit_pixel[i].y, 20);
        }
        EXPECT_NEAR(static_cast<double>(hits) / static_cast<double>(rays), 0.125, jitter > 0 ? 0.05 : 1e-9);
    }
}

TEST(Strides, JitterIsTheSameAtEveryRunAndAnotherInEveryPixel)
{
    for (const std::string_view id : both) {
        const auto traced = [&](double jitter) {
            return trace_with(wall_picture(), id, {{"stride_px", 8}, {"jitter", jitter}}, thin);
        };
        const TraceImage still = traced(0), jittered = traced(1);
        std::string      first;
        EXPECT_EQ(count_differences(jittered, traced(1), bit_equal_t, first), 0U) << id << " " << first;
        EXPECT_GT(count_differences(jittered, still, bit_equal_t, first), 64U * 5) << id;
        // All columns see the same; only jitter tells them apart.
        size_t other_still = 0, other_jittered = 0;
        for (size_t i = 48 * 64 + 1; i < 49 * 64; ++i) {
            other_still += still.hit_pixel[i].y != still.hit_pixel[i - 1].y;
            other_jittered += jittered.hit_pixel[i].y != jittered.hit_pixel[i - 1].y;
        }
        EXPECT_EQ(other_still, 0U) << id;
        EXPECT_GT(other_jittered, 20U) << id;
    }
}

// Without a thickness that would end it earlier, each step of the search halves what the stride left open.
TEST(StridedDirection, EachBinaryStepHalvesTheError)
{
    double before = infinity;
    for (int steps = 0; steps <= 4; ++steps) {
        const TraceImage result =
            trace_with(wall_picture(), "strided_direction", {{"binary_steps", steps}, {"min_alignment", 0}}, unlimited);
        const std::vector<double> errors = errors_px(result);
        EXPECT_LE(largest(errors), 16 / std::exp2(steps) + 1) << steps;
        EXPECT_LT(mean(errors), before) << steps;
        before = std::max(0.75 * mean(errors), 1e-3); // the pixel itself is met exactly
    }
}

// A quarter of the default stride in a picture a quarter as wide.
const ParameterValues strides_of_4{{"stride_px", 4}, {"binary_steps", 2}};

TEST(StridedDirection, FindsTheWall)
{
    // Nearer, a stride that ends behind the wall no longer ends in the ray's direction.
    EXPECT_LE(largest(errors_px(trace_with(wall_picture(), "strided_direction", strides_of_4, thin), 10)), 1);
    // Where a stride ends, the ray is already behind a thin wall: without the search, only the rays whose samples fall on the crossing find it.
    const TraceImage coarse = trace_with(wall_picture(), "strided_direction", {{"stride_px", 4}, {"binary_steps", 0}},
                                         boxes({.thickness_m = 0.01, .max_distance_m = 20}));
    EXPECT_LE(std::ranges::count(coarse.status, TraceStatus::hit), 64 * 10);
}

// A bar at 2 m that the rays pass far behind on their way to the wall: with unlimited thickness depth alone takes it for a hit.
TEST(StridedDirection, RejectsWhatDoesNotLieInTheRaysDirection)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 10);
    for (int y = 28; y < 36; ++y)
        for (int x = 0; x < 64; ++x) set_pixel(image, x, y, 2, {0, 0, 1}, 0);
    const auto rows_hit = [&](double min_alignment) {
        const TraceImage result =
            trace_with(image, "strided_direction",
                       {{"stride_px", 4}, {"binary_steps", 2}, {"min_alignment", min_alignment}}, unlimited);
        std::array<size_t, 2> hits{}; // bar, wall
        for (size_t i = 46 * 64; i < 52 * 64; ++i)
            if (result.status[i] == TraceStatus::hit) ++hits[result.hit_pixel[i].y < 28];
        return hits;
    };
    const auto depth_alone = rows_hit(-1), tested = rows_hit(0.99);
    EXPECT_EQ(depth_alone[0], 6U * 64) << "every ray stops at the bar";
    EXPECT_EQ(tested[0], 0U);
    EXPECT_EQ(tested[1], 6U * 64) << "every ray goes on to the wall";
}

TEST(StridedDirection, IsMoreTolerantOfSurfacesThatFaceDown)
{
    GBufferImage down = wall_picture();
    for (size_t i = 0; i < down.depth.size(); ++i)
        if (down.metallic[i] == 0) down.normal_vs[i] = {0, -1, 0};
    const auto hits = [](const GBufferImage& image, double alignment_down) {
        const TraceImage result =
            trace_with(image, "strided_direction",
                       {{"stride_px", 4}, {"min_alignment", 1}, {"min_alignment_down", alignment_down}}, unlimited);
        return std::ranges::count(result.status, TraceStatus::hit);
    };
    EXPECT_LT(hits(wall_picture(), 0.9), 64 * 4) << "an upright wall is not exactly in the ray's direction";
    EXPECT_EQ(hits(down, 0.9), 64 * 20);
    EXPECT_EQ(hits(down, 1), hits(wall_picture(), 0.9));
}

// The facing test is the experiment's setting.
TEST(Strides, ObeyTheFacingRule)
{
    GBufferImage turned = wall_picture();
    for (size_t i = 0; i < turned.depth.size(); ++i)
        if (turned.metallic[i] == 0) turned.normal_vs[i] = {0, 0, -1};
    for (const std::string_view id : both) {
        const size_t i = 52 * 64 + 20;
        EXPECT_EQ(
            trace_with(turned, id, {{"stride_px", 4}}, boxes({.thickness_m = 0.5, .max_distance_m = 20}, Behind::pass))
                .status[i],
            TraceStatus::facing_away)
            << id;
        EXPECT_EQ(trace_with(turned, id, {{"stride_px", 4}}, thin).status[i], TraceStatus::hit) << id;
    }
}

} // namespace
} // namespace ssrlab::test
