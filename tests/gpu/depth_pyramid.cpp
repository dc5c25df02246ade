// The depth pyramid against brute force: every cell of every level, at sizes that halving does not divide.
#include "gpu/device.h"
#include "render/frame_passes.h"
#include "shared.h"
#include "truth/screen_truth.h"
#include "unit/truth_gbuffers.h"

#include <algorithm>
#include <array>
#include <bit>

namespace ssrlab::test {
namespace {

struct Pyramid {
    glm::ivec2              size_px, atlas_size_px;
    int                     levels = 0;
    std::vector<glm::uvec2> atlas;

    glm::ivec2 size(int level) const { return ((size_px - 1) >> level) + 1; }
    glm::uvec2 at(int level, int x, int y) const
    {
        const int left = atlas_size_px.x - (atlas_size_px.x >> (level - 1));
        return atlas.at(static_cast<size_t>(y * atlas_size_px.x + left + x));
    }
};

Pyramid build(const Picture& picture, const TraceSettings& settings, double kind)
{
    const Technique& hiz   = technique("hiz");
    const auto       frame = prepare_frame(device(), picture.buffers, hiz,
                                           values_of(hiz, {{"pyramid", kind}, {"top_level", 14}}), {settings});
    submit(device(), [&](const vk::raii::CommandBuffer& commands) { record_pyramid(commands, frame->pyramid); });
    const PyramidImages& images = picture.buffers->pyramid;
    return {picture.view.size_px, images.atlas.size_px, images.levels, download_as<glm::uvec2>(device(), images.atlas)};
}

/// Levels: as many halvings, rounded up, as it takes to reach one cell.
int expected_levels(glm::ivec2 size)
{
    int levels = 0;
    for (int n = std::max(size.x, size.y); n > 1; n = (n + 1) / 2) ++levels;
    return levels;
}

/// The top bits of the number, from 2^-31 up: 11 bits of mantissa (shaders/pyramid_cell.glsl).
uint32_t code(double depth)
{
    const auto bits = std::bit_cast<int32_t>(static_cast<float>(depth));
    return static_cast<uint32_t>(std::clamp((bits >> 12) - (PYRAMID_LOWEST_EXPONENT << 11), 0, PYRAMID_MAX_CODE));
}

/// One bit per bin between two codes, of the narrowest 32 bins (2^shift codes each) that reach from farthest to nearest.
uint32_t bins(uint32_t low, uint32_t high, uint32_t farthest, uint32_t nearest)
{
    uint32_t shift = 0, mask = 0;
    while ((nearest >> shift) - (farthest >> shift) > 31) ++shift;
    for (uint32_t bin = low >> shift; bin <= high >> shift; ++bin) mask |= 1U << (bin - (farthest >> shift));
    return mask;
}

/// The cell of one level, from all its pixels. The back is rounded outward, by 2^-20 at most: both roundings of its code are right.
struct Expected {
    uint32_t nearest = 0, farthest_low = PYRAMID_MAX_CODE, farthest_high = PYRAMID_MAX_CODE, least_bins = 0,
             most_bins = 0;
};

/// stored_farthest: the bins begin there, and it may be rounded.
Expected expect_cell(const GBufferImage& image, const TraceSettings& settings, int kind, int level, int x, int y,
                     uint32_t stored_farthest)
{
    Expected                             cell;
    const glm::ivec2                     size = image.view.size_px;
    std::vector<std::array<uint32_t, 3>> slabs; // outer and inner back, front
    for (int py = y << level; py < std::min((y + 1) << level, size.y); ++py)
        for (int px = x << level; px < std::min((x + 1) << level, size.x); ++px) {
            const double depth = static_cast<double>(image.depth[at(image, px, py)]);
            if (depth <= 0) continue;
            const double   back  = kind == PYRAMID_NEAREST ? 0 : slab_back(image.view, depth, settings);
            const uint32_t front = code(depth), inner = code(back), outer = code(back * (1 - 4e-6));
            cell.nearest       = std::max(cell.nearest, front);
            cell.farthest_low  = std::min(cell.farthest_low, outer);
            cell.farthest_high = std::min(cell.farthest_high, inner);
            slabs.push_back({outer, inner, front});
        }
    for (const auto& [outer, inner, front] : slabs) {
        const bool occupancy = kind == PYRAMID_OCCUPANCY;
        const auto from      = [&](uint32_t back) { return std::max(back, stored_farthest); };
        cell.least_bins |= occupancy ? bins(from(inner), front, stored_farthest, cell.nearest) : ~0U;
        cell.most_bins |= occupancy ? bins(from(outer), front, stored_farthest, cell.nearest) : ~0U;
    }
    return cell;
}

void expect_cells(const Pyramid& pyramid, const GBufferImage& image, const TraceSettings& settings, int kind)
{
    ASSERT_EQ(pyramid.levels, expected_levels(pyramid.size_px));
    size_t wrong = 0;
    for (int level = 1; level <= pyramid.levels; ++level)
        for (int y = 0; y < pyramid.size(level).y; ++y)
            for (int x = 0; x < pyramid.size(level).x; ++x) {
                const glm::uvec2 cell    = pyramid.at(level, x, y);
                const uint32_t   nearest = cell.x >> 16, farthest = cell.x & PYRAMID_MAX_CODE;
                const Expected   expected = expect_cell(image, settings, kind, level, x, y, farthest);
                const bool       right    = nearest == expected.nearest && farthest >= expected.farthest_low &&
                                   farthest <= expected.farthest_high &&
                                   (cell.y & expected.least_bins) == expected.least_bins &&
                                   (cell.y & ~expected.most_bins) == 0;
                if (!right && wrong++ < 3)
                    ADD_FAILURE() << fmt::format("{}x{}, kind {}: level {}, cell ({}, {}): nearest {} farthest {} bins "
                                                 "{:08x}, expected {}, {} to {}, {:08x}",
                                                 pyramid.size_px.x, pyramid.size_px.y, kind, level, x, y, nearest,
                                                 farthest, cell.y, expected.nearest, expected.farthest_low,
                                                 expected.farthest_high, expected.least_bins);
            }
    EXPECT_EQ(wrong, 0U);
}

class DepthPyramid : public testing::TestWithParam<glm::ivec2> {};

TEST_P(DepthPyramid, EqualsBruteForceOnRandomDepth)
{
    const Picture picture = make_picture(random_gbuffer(bench_view(GetParam()), 7));
    for (const int kind : {PYRAMID_OCCUPANCY, PYRAMID_MINMAX, PYRAMID_NEAREST})
        for (const TraceSettings& settings : {TraceSettings{.thickness_m = 0.1}, TraceSettings{.thickness_m = 0},
                                              TraceSettings{.thickness_m = std::numeric_limits<double>::infinity()},
                                              TraceSettings{.thickness_m = 0.2, .thickness_relative = true}})
            expect_cells(build(picture, settings, kind), picture.image, settings, kind);
}

// A last row or column that a level drops would hide the only texel that is near.
TEST_P(DepthPyramid, SeesTheOnlyNearTexelInEveryCornerAndBorder)
{
    const glm::ivec2 size = GetParam(), last = size - 1;
    for (const glm::ivec2& near : {glm::ivec2(0), glm::ivec2(last.x, 0), glm::ivec2(0, last.y), last,
                                   glm::ivec2(last.x, last.y / 2), glm::ivec2(last.x / 2, last.y)}) {
        GBufferImage image = empty_gbuffer(bench_view(size));
        std::ranges::fill(image.depth, 0.01F);
        image.depth[at(image, near.x, near.y)] = 0.75F;
        const Pyramid pyramid                  = build(make_picture(image), {}, PYRAMID_OCCUPANCY);
        ASSERT_EQ(pyramid.levels, expected_levels(size));
        for (int level = 1; level <= pyramid.levels; ++level)
            for (int y = 0; y < pyramid.size(level).y; ++y)
                for (int x = 0; x < pyramid.size(level).x; ++x)
                    ASSERT_EQ(pyramid.at(level, x, y).x >> 16, code((near >> level) == glm::ivec2(x, y) ? 0.75 : 0.01))
                        << size.x << "x" << size.y << ", near texel (" << near.x << ", " << near.y << "), level "
                        << level << ", cell (" << x << ", " << y << ")";
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DepthPyramid,
                         testing::Values(glm::ivec2(1, 1), glm::ivec2(1, 37), glm::ivec2(97, 1), glm::ivec2(2, 1),
                                         glm::ivec2(3, 3), glm::ivec2(17, 31), glm::ivec2(64, 64), glm::ivec2(65, 63),
                                         glm::ivec2(127, 131), glm::ivec2(641, 359), glm::ivec2(1366, 768)),
                         [](const auto& param) { return fmt::format("{}x{}", param.param.x, param.param.y); });

TEST(DepthPyramidOrthographic, EqualsBruteForce)
{
    View view             = bench_view({65, 43});
    view.projection       = Projection::orthographic;
    view.focal_px         = glm::dvec2(10);
    view.far_m            = 20;
    const Picture picture = make_picture(random_gbuffer(view, 3));
    for (const bool relative : {false, true})
        expect_cells(build(picture, {.thickness_m = 0.1, .thickness_relative = relative}, PYRAMID_OCCUPANCY),
                     picture.image, {.thickness_m = 0.1, .thickness_relative = relative}, PYRAMID_OCCUPANCY);
}

// NaN, infinities, negative numbers and depths nearer than the near plane are background, and disturb no other pixel.
TEST(UnusableDepth, IsBackgroundAndChangesNothingElse)
{
    constexpr float infinity   = std::numeric_limits<float>::infinity();
    GBufferImage    clean      = random_gbuffer(bench_view({127, 65}), 11);
    GBufferImage    spoilt     = clean;
    const float     unusable[] = {
            std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, -0.5F, 1.5F, -0.0F, std::nextafter(1.0F, 2.0F)};
    for (size_t i = 5; i < clean.depth.size(); i += 13) {
        clean.depth[i]  = 0;
        spoilt.depth[i] = unusable[i % std::size(unusable)];
    }
    const Picture       good = make_picture(clean), bad = make_picture(spoilt);
    const TraceSettings settings{.thickness_m = 0.3};
    EXPECT_EQ(good.image.depth, bad.image.depth);
    expect_cells(build(bad, settings, PYRAMID_OCCUPANCY), clean, settings, PYRAMID_OCCUPANCY);
    std::string first;
    for (const char* id : {"dda", "hiz", "linear", "linear_binary"}) {
        const Technique& t = technique(id);
        EXPECT_EQ(count_differences(trace(good, t, values_of(t), settings), trace(bad, t, values_of(t), settings), true,
                                    first),
                  0U)
            << id << ": " << first;
    }
    EXPECT_EQ(count_differences(trace(bad, technique("hiz"), values_of(technique("hiz")), settings),
                                trace(bad, technique("dda"), values_of(technique("dda")), settings), true, first),
              0U)
        << first;
}

} // namespace
} // namespace ssrlab::test
