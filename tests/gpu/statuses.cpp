// What is not traced, and pictures that are shifted.
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

TraceStatus status_at(const TraceImage& result, int x, int y)
{
    return result.status.at(pixel_index({x, y}, result.size_px));
}

class Statuses : public testing::TestWithParam<const char*> {
protected:
    static TraceImage trace_with(const GBufferImage& image, const TraceSettings& settings)
    {
        const Technique& t = technique(GetParam());
        return trace(make_picture(image), t, values_of(t), settings);
    }
};

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
    const TraceImage result           = trace_with(image, boxes({.thickness_m = 0.5, .max_distance_m = 20}));
    for (int x = 1; x <= 6; ++x) EXPECT_EQ(status_at(result, x, 50), TraceStatus::not_traced) << x;
    EXPECT_NE(status_at(result, 7, 50), TraceStatus::not_traced);
    EXPECT_EQ(status_at(result, 7, 20), TraceStatus::not_traced) << "the wall does not reflect";
    // Normals of any length are as good as unit ones.
    GBufferImage scaled = floor_and_wall(bench_view({64, 64}), 10);
    for (auto& normal : scaled.normal_vs) normal *= 1e-20F;
    const TraceImage a = trace_with(scaled, boxes({.thickness_m = 0.5})),
                     b = trace_with(floor_and_wall(bench_view({64, 64}), 10), boxes({.thickness_m = 0.5}));
    std::string first;
    EXPECT_EQ(count_differences(a, b, any_t, first), 0U) << first;
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
        for (const auto [from, x, y] : pixels_of(window)) {
            const size_t to     = at(image, corner.x + x, corner.y + y);
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
            const TraceSettings settings = boxes({.thickness_m = 0.2, .max_distance_m = 1.5});
            const TraceImage    a        = trace(picture, technique(id), values_of(technique(id)), settings);
            const TraceImage    b        = trace(moved, technique(id), values_of(technique(id)), settings);
            size_t              hits     = 0;
            for (const auto [place, x, y] : pixels_of(window)) {
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
