// Every status is produced where it should be, on G-buffers whose answers are known.
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "unit/truth_gbuffers.h"

#include <limits>

namespace ssrlab::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TraceStatus status_at(const TraceResult& result, int x, int y)
{
    return result.status.at(pixel_index({x, y}, result.size_px));
}

class Statuses : public testing::TestWithParam<const char*> {
protected:
    TraceResult trace_with(const GBufferImage& image, const TraceSettings& settings,
                           const ParameterValues& changed = {}) const
    {
        const Technique& t = technique(GetParam());
        return trace(make_picture(image), t, values_of(t, changed), settings);
    }
    bool exact() const { return technique(GetParam()).exact; }
};

// 64 x 64, floor before a wall at 10 m: the floor at row 48 shows the wall at row 70.4 - 48.5 = 21.9.
TEST_P(Statuses, HitOnTheWall)
{
    const TraceResult result =
        trace_with(floor_and_wall(bench_view({64, 64}), 10), {.thickness_m = 0.5, .max_distance_m = 20});
    for (int x = 0; x < 64; ++x) {
        ASSERT_EQ(status_at(result, x, 48), TraceStatus::hit);
        const glm::ivec2 pixel = result.hit_pixel[pixel_index({x, 48}, result.size_px)];
        EXPECT_EQ(pixel.x, x);
        EXPECT_NEAR(pixel.y, 21, exact() ? 0 : 1);
    }
}

// Without a wall the same rays leave upwards, or, limited to 3 m, end inside the picture.
TEST_P(Statuses, LeftScreenAndPastMaxDistance)
{
    const GBufferImage floor = floor_and_wall(bench_view({64, 64}), infinity);
    EXPECT_EQ(status_at(trace_with(floor, {.max_distance_m = 1e4}), 20, 60),
              TraceStatus::past_max_distance); // runs toward the horizon
    EXPECT_EQ(status_at(trace_with(floor, {.max_distance_m = 0.5}), 20, 60), TraceStatus::past_max_distance);
    GBufferImage upright = empty_gbuffer(bench_view({64, 64}));
    // A mirror tilted by 45 degrees turns the ray straight up.
    for (int x = 0; x < 64; ++x) set_pixel(upright, x, 40, 5, {0, 1, 1}, 1);
    EXPECT_EQ(status_at(trace_with(upright, {.max_distance_m = 1e4}), 32, 40), TraceStatus::left_screen);
    EXPECT_EQ(status_at(trace_with(upright, {.max_distance_m = 1}), 32, 40), TraceStatus::past_max_distance);
    // Toward the camera: the near plane counts as leaving.
    GBufferImage frontal = empty_gbuffer(bench_view({64, 64}));
    set_pixel(frontal, 31, 31, 5, {0, 0, 1}, 1);
    EXPECT_EQ(status_at(trace_with(frontal, {.max_distance_m = 1e4}), 31, 31), TraceStatus::left_screen);
}

TEST_P(Statuses, NotTraced)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 10);
    const float  nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    image.metallic[at(image, 1, 50)]  = 0;
    image.normal_vs[at(image, 2, 50)] = glm::vec3(0);
    image.normal_vs[at(image, 3, 50)] = {0, nan, 0};
    image.normal_vs[at(image, 4, 50)] = {inf, 0, 0};
    image.depth[at(image, 5, 50)]     = 0;
    image.metallic[at(image, 6, 50)]  = nan;
    const TraceResult result          = trace_with(image, {.thickness_m = 0.5, .max_distance_m = 20});
    for (int x = 1; x <= 6; ++x) EXPECT_EQ(status_at(result, x, 50), TraceStatus::not_traced) << x;
    EXPECT_NE(status_at(result, 7, 50), TraceStatus::not_traced);
    EXPECT_EQ(status_at(result, 7, 20), TraceStatus::not_traced) << "the wall does not reflect";
    // Normals of any length are as good as unit ones.
    GBufferImage scaled = floor_and_wall(bench_view({64, 64}), 10);
    for (auto& normal : scaled.normal_vs) normal *= 1e-20F;
    const TraceResult a = trace_with(scaled, {.thickness_m = 0.5}),
                      b = trace_with(floor_and_wall(bench_view({64, 64}), 10), {.thickness_m = 0.5});
    std::string first;
    EXPECT_EQ(count_differences(a, b, any_t, first), 0U) << first;
}

// The wall faces the camera and so the rays that come from before it; turned round, it must not be hit.
TEST_P(Statuses, FacingAwayOnlyWithTheRule)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 10);
    for (size_t i = 0; i < image.depth.size(); ++i)
        if (image.metallic[i] == 0) image.normal_vs[i] = {0, 0, -1};
    EXPECT_EQ(status_at(trace_with(image, {.thickness_m = 0.5, .max_distance_m = 20, .behind = Behind::pass}), 20, 48),
              TraceStatus::facing_away);
    EXPECT_EQ(status_at(trace_with(image, {.thickness_m = 0.5, .max_distance_m = 20, .behind = Behind::hit}), 20, 48),
              TraceStatus::hit);
    EXPECT_EQ(status_at(trace_with(floor_and_wall(bench_view({64, 64}), 10),
                                   {.thickness_m = 0.5, .max_distance_m = 20, .behind = Behind::pass}),
                        20, 48),
              TraceStatus::hit);
}

// A budget of k: k steps and no more, out_of_steps unless the ray was done, and what is found is what the full budget finds.
TEST_P(Statuses, OutOfStepsIsNeverAHit)
{
    if (!exact()) GTEST_SKIP() << "a march always gets through its steps";
    const GBufferImage  image = random_gbuffer(bench_view({97, 61}), 2);
    const TraceSettings settings{.thickness_m = 0.2};
    const TraceResult   full = trace_with(image, settings);
    for (const int budget : {0, 1, 2, 3, 7, 20}) {
        const TraceResult cut     = trace_with(image, settings, {{"max_steps", budget}});
        size_t            gave_up = 0;
        for (size_t i = 0; i < cut.status.size(); ++i) {
            EXPECT_LE(cut.steps[i], static_cast<uint32_t>(budget)) << i;
            const bool enough = full.steps[i] <= static_cast<uint32_t>(budget);
            EXPECT_EQ(cut.status[i], enough ? full.status[i] : TraceStatus::out_of_steps)
                << "ray of pixel " << i << ", budget " << budget << " of " << full.steps[i];
            gave_up += cut.status[i] == TraceStatus::out_of_steps;
        }
        EXPECT_GT(gave_up, 0U) << budget;
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Statuses, testing::Values("dda", "hiz", "linear", "linear_binary"),
                         [](const auto& param) { return std::string(param.param); });

// Rays that end inside the image do not know where its borders are: the same picture k pixels further gives the same hits k pixels
// further, bit for bit, although the pyramid's cells now hold other pixels.
TEST(ShiftedPicture, HitsMoveByExactlyTheShift)
{
    constexpr glm::ivec2 canvas{200, 140}, window{96, 64};
    const auto           placed = [&](glm::ivec2 corner) {
        View small         = bench_view(window);
        small.focal_px     = glm::dvec2(48);
        const auto inner   = random_gbuffer(small, 4);
        View       view    = bench_view(canvas);
        view.focal_px      = glm::dvec2(48);
        view.centre_px     = glm::dvec2(corner) + 0.5 * glm::dvec2(window);
        GBufferImage image = empty_gbuffer(view);
        for (int y = 0; y < window.y; ++y)
            for (int x = 0; x < window.x; ++x) {
                const size_t from = at(inner, x, y), to = at(image, corner.x + x, corner.y + y);
                image.depth[to]     = inner.depth[from];
                image.normal_vs[to] = inner.normal_vs[from];
                image.metallic[to]  = inner.metallic[from];
            }
        return make_picture(image);
    };
    constexpr glm::ivec2 home{50, 40};
    const Picture        picture = placed(home);
    for (const glm::ivec2& corner : {glm::ivec2(51, 40), glm::ivec2(47, 45), glm::ivec2(50, 33)}) {
        const Picture moved = placed(corner);
        for (const char* id : {"dda", "hiz"}) {
            const TraceSettings settings{.thickness_m = 0.2, .max_distance_m = 1.5};
            const TraceResult   a    = trace(picture, technique(id), values_of(technique(id)), settings);
            const TraceResult   b    = trace(moved, technique(id), values_of(technique(id)), settings);
            size_t              hits = 0;
            for (int y = 0; y < window.y; ++y)
                for (int x = 0; x < window.x; ++x) {
                    const auto i = pixel_index(home + glm::ivec2(x, y), canvas),
                               j = pixel_index(corner + glm::ivec2(x, y), canvas);
                    if (a.status[i] == TraceStatus::left_screen || b.status[j] == TraceStatus::left_screen) continue;
                    // A ray clipped at the border in one picture alone has another segment: same pixel, other t.
                    ASSERT_EQ(a.status[i], b.status[j]) << id << " " << x << ", " << y;
                    if (a.status[i] != TraceStatus::hit) continue;
                    ++hits;
                    ASSERT_EQ(a.hit_pixel[i] - home, b.hit_pixel[j] - corner) << id << " " << x << ", " << y;
                }
            EXPECT_GT(hits, 100U);
        }
    }
}

} // namespace
} // namespace ssrlab::test
