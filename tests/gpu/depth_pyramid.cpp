// The depth pyramid against brute force: every cell of every level, at sizes that halving does not divide.
#include "gpu/device.h"
#include "render/frame_passes.h"
#include "shared.h"
#include "truth/screen_truth.h"
#include "unit/truth_gbuffers.h"

#include <algorithm>

namespace ssrlab::test {
namespace {

struct Pyramid {
    glm::ivec2             size_px, atlas_size_px;
    int                    levels = 0;
    std::vector<glm::vec2> atlas;

    glm::ivec2 size(int level) const { return ((size_px - 1) >> level) + 1; }
    glm::vec2  at(int level, int x, int y) const
    {
        const int left = atlas_size_px.x - (atlas_size_px.x >> (level - 1));
        return atlas.at(static_cast<size_t>(y * atlas_size_px.x + left + x));
    }
};

Pyramid build(const Picture& picture, const TraceSettings& settings, double kind)
{
    const Technique& hiz   = technique("hiz");
    const auto       frame = prepare_frame(device(), picture.buffers, hiz, values_of(hiz, {{"pyramid", kind}, {"top_level", 14}}), {settings, {}});
    submit(device(), [&](const vk::raii::CommandBuffer& commands) { record_pyramid(commands, frame->pyramid); });
    const PyramidImages& images = picture.buffers->pyramid;
    return {picture.view.size_px, images.atlas.size_px, images.levels, download_as<glm::vec2>(device(), images.atlas)};
}

/// Levels: as many halvings, rounded up, as it takes to reach one cell.
int expected_levels(glm::ivec2 size)
{
    int levels = 0;
    for (int n = std::max(size.x, size.y); n > 1; n = (n + 1) / 2) ++levels;
    return levels;
}

/// What a cell must hold: the nearest depth, bit for bit; the farthest back, rounded outward by at most 4e-6 of itself.
void expect_cells(const Pyramid& pyramid, const GBufferImage& image, const TraceSettings& settings, bool nearest_only)
{
    ASSERT_EQ(pyramid.levels, expected_levels(pyramid.size_px));
    size_t wrong = 0;
    for (int level = 1; level <= pyramid.levels; ++level)
        for (int y = 0; y < pyramid.size(level).y; ++y)
            for (int x = 0; x < pyramid.size(level).x; ++x) {
                float  front = static_cast<float>(BACKGROUND_DEPTH), back_of_cells = 2;
                double back = 2;
                for (int py = y << level; py < std::min((y + 1) << level, pyramid.size_px.y); ++py)
                    for (int px = x << level; px < std::min((x + 1) << level, pyramid.size_px.x); ++px) {
                        const float depth = image.depth[at(image, px, py)];
                        if (depth <= 0) continue;
                        front         = std::max(front, depth);
                        back          = std::min(back, slab_back(image.view, static_cast<double>(depth), settings));
                        back_of_cells = std::min(back_of_cells, pyramid.at(1, px >> 1, py >> 1).y);
                    }
                const glm::vec2 cell = pyramid.at(level, x, y);
                const bool      empty = front < 0;
                const double    stored = cell.y, slack = 4e-6 * std::abs(back) + (back < 0 ? 2e-6 : 0);
                const bool      back_right = empty ? cell.y == 2 : nearest_only ? cell.y == -1e30F : cell.y == back_of_cells && stored <= back && stored >= back - slack;
                if (cell.x == front && back_right) continue;
                if (wrong++ < 3)
                    ADD_FAILURE() << fmt::format("{}x{}: level {}, cell ({}, {}): ({}, {}), expected ({}, {})", pyramid.size_px.x, pyramid.size_px.y, level, x, y, cell.x, cell.y, front, back);
            }
    EXPECT_EQ(wrong, 0U);
}

class DepthPyramid : public testing::TestWithParam<glm::ivec2> {};

TEST_P(DepthPyramid, EqualsBruteForceOnRandomDepth)
{
    const Picture picture = make_picture(random_gbuffer(bench_view(GetParam()), 7));
    for (const double thickness : {0.1, 0.0, std::numeric_limits<double>::infinity()})
        expect_cells(build(picture, {.thickness_m = thickness}, PYRAMID_MINMAX), picture.image, {.thickness_m = thickness}, false);
    expect_cells(build(picture, {.thickness_m = 0.2, .thickness_relative = true}, PYRAMID_MINMAX), picture.image, {.thickness_m = 0.2, .thickness_relative = true}, false);
    expect_cells(build(picture, {}, PYRAMID_NEAREST), picture.image, {}, true);
}

// A last row or column that a level drops would hide the only texel that is near.
TEST_P(DepthPyramid, SeesTheOnlyNearTexelInEveryCornerAndBorder)
{
    const glm::ivec2 size = GetParam(), last = size - 1;
    for (const glm::ivec2& near : {glm::ivec2(0), glm::ivec2(last.x, 0), glm::ivec2(0, last.y), last, glm::ivec2(last.x, last.y / 2), glm::ivec2(last.x / 2, last.y)}) {
        GBufferImage image = empty_gbuffer(bench_view(size));
        std::ranges::fill(image.depth, 0.01F);
        image.depth[at(image, near.x, near.y)] = 0.75F;
        const Pyramid pyramid = build(make_picture(image), {}, PYRAMID_MINMAX);
        ASSERT_EQ(pyramid.levels, expected_levels(size));
        for (int level = 1; level <= pyramid.levels; ++level)
            for (int y = 0; y < pyramid.size(level).y; ++y)
                for (int x = 0; x < pyramid.size(level).x; ++x)
                    ASSERT_EQ(pyramid.at(level, x, y).x, (near >> level) == glm::ivec2(x, y) ? 0.75F : 0.01F)
                        << size.x << "x" << size.y << ", near texel (" << near.x << ", " << near.y << "), level " << level << ", cell (" << x << ", " << y << ")";
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DepthPyramid,
                         testing::Values(glm::ivec2(1, 1), glm::ivec2(1, 37), glm::ivec2(97, 1), glm::ivec2(2, 1), glm::ivec2(3, 3), glm::ivec2(17, 31), glm::ivec2(64, 64),
                                         glm::ivec2(65, 63), glm::ivec2(127, 131), glm::ivec2(641, 359), glm::ivec2(1366, 768)),
                         [](const auto& param) { return fmt::format("{}x{}", param.param.x, param.param.y); });

TEST(DepthPyramidOrthographic, EqualsBruteForce)
{
    View view       = bench_view({65, 43});
    view.projection = Projection::orthographic;
    view.focal_px   = glm::dvec2(10);
    view.far_m      = 20;
    const Picture picture = make_picture(random_gbuffer(view, 3));
    for (const bool relative : {false, true})
        expect_cells(build(picture, {.thickness_m = 0.1, .thickness_relative = relative}, PYRAMID_MINMAX), picture.image, {.thickness_m = 0.1, .thickness_relative = relative}, false);
}

// NaN, infinities, negative numbers and depths nearer than the near plane are background, and disturb no other pixel.
TEST(UnusableDepth, IsBackgroundAndChangesNothingElse)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    GBufferImage    clean    = random_gbuffer(bench_view({127, 65}), 11);
    GBufferImage    spoilt   = clean;
    const float     unusable[] = {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, -0.5F, 1.5F, -0.0F, std::nextafter(1.0F, 2.0F)};
    for (size_t i = 5; i < clean.depth.size(); i += 13) {
        clean.depth[i]  = 0;
        spoilt.depth[i] = unusable[i % std::size(unusable)];
    }
    const Picture       good = make_picture(clean), bad = make_picture(spoilt);
    const TraceSettings settings{.thickness_m = 0.3};
    EXPECT_EQ(good.image.depth, bad.image.depth);
    expect_cells(build(bad, settings, PYRAMID_MINMAX), clean, settings, false);
    std::string first;
    for (const char* id : {"dda", "hiz", "linear", "linear_binary"}) {
        const Technique& t = technique(id);
        EXPECT_EQ(count_differences(trace(good, t, values_of(t), settings), trace(bad, t, values_of(t), settings), true, first), 0U) << id << ": " << first;
    }
    EXPECT_EQ(count_differences(trace(bad, technique("hiz"), values_of(technique("hiz")), settings), trace(bad, technique("dda"), values_of(technique("dda")), settings), true, first), 0U) << first;
}

} // namespace
} // namespace ssrlab::test
