// The depth pyramid against brute force: every cell of every level, at sizes that halving does not divide.
#include "core/pixel_index.h"
#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "shared.h"
#include "truth/screen_truth.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

/// Choices of depth_pyramid.kind.
enum Kind : int { occupancy, minmax, nearest_only };

struct Pyramid {
    glm::ivec2              size_px;
    std::vector<glm::uvec2> cells;

    glm::ivec2 size(int level) const { return ((size_px - 1) >> level) + 1; }
    glm::uvec2 at(int level, int x, int y) const
    {
        return cells.at(cell_index(size_px, {x << level, y << level}, level));
    }
    uint32_t pixel(int x, int y) const
    {
        const glm::uvec2 pair = cells.at(cell_index(size_px, {x, y}, 0));
        return x % 2 == 0 ? pair.x : pair.y;
    }
};

Pyramid build(const Picture& picture, const TraceSettings& settings, double kind)
{
    const Technique& hiz = technique("hiz");
    const auto       frame =
        prepared_frame(picture.buffers, hiz,
                       values_of(hiz, {{"depth_pyramid.kind", kind}, {"depth_pyramid.top_level", 14}}), {settings});
    submit(device(), [&](const Commands& commands) { record_depth_structures(commands, *frame->inputs.lab); });
    const Buffer& cells = picture.buffers->gbuffer->depth.cells;
    return {picture.view.size_px, download_as<glm::uvec2>(device(), cells, cells.bytes / sizeof(glm::uvec2))};
}

/// Levels: as many halvings, rounded up, as it takes to reach one row of cells.
int expected_levels(glm::ivec2 size)
{
    int levels = 0;
    for (int n = size.y; n > 1; n = (n + 1) / 2) ++levels;
    return levels;
}

uint32_t bits(double depth) { return std::bit_cast<uint32_t>(static_cast<float>(depth)); }

/// The nearest front as a cell keeps it: rounded up to a multiple of 32.
uint32_t rounded_front(double depth) { return (bits(depth) + 31) & ~31U; }

/// The narrowest bins, at least 2^5 wide, of which 32 reach from front to back (bits of depth).
uint32_t narrowest_shift(uint32_t front, uint32_t back)
{
    uint32_t shift = 5;
    while ((front >> shift) - (back >> shift) > 31) ++shift;
    return shift;
}

/// One bit per bin between a front and a back, counted from the cell's nearest.
uint32_t bins(uint32_t nearest, uint32_t front, uint32_t back, uint32_t shift)
{
    uint32_t mask = 0;
    for (uint32_t bin = back >> shift; bin <= front >> shift; ++bin) mask |= 1U << ((nearest >> shift) - bin);
    return mask;
}

/// Is this the cell of its pixels? Their backs are rounded outward, by 2^-20 at most: both roundings are right.
bool is_right(glm::uvec2 cell, const GBufferImage& image, const TraceSettings& settings, int kind, int level, int x,
              int y)
{
    struct Slab {
        uint32_t front, inner_back, outer_back; // bits of depth
    };
    const glm::ivec2  size = image.view.size_px;
    std::vector<Slab> slabs;
    Slab              all{0, ~0U, ~0U};
    for (int py = y << level; py < std::min((y + 1) << level, size.y); ++py)
        for (int px = x << level; px < std::min((x + 1) << level, size.x); ++px) {
            const double depth = static_cast<double>(image.depth[at(image, px, py)]);
            if (depth <= 0) continue;
            const double back = kind == nearest_only ? 0 : std::max(slab_back(image.view, depth, settings), 0.0);
            const Slab   slab{bits(depth), bits(back), bits(back * (1 - 4e-6))};
            slabs.push_back(slab);
            all = {std::max(all.front, rounded_front(depth)), std::min(all.inner_back, slab.inner_back),
                   std::min(all.outer_back, slab.outer_back)};
        }
    if (slabs.empty()) return cell == glm::uvec2(0);
    const uint32_t shift = cell.x & 31;
    uint32_t       least = 0, most = 0;
    for (const Slab& slab : slabs) {
        // Without occupancy everything from the nearest front to the farthest back is full.
        const uint32_t front = kind == occupancy ? slab.front : all.front;
        least |= bins(all.front, front, slab.inner_back, shift);
        most |= bins(all.front, front, slab.outer_back, shift);
    }
    return (cell.x & ~31U) == all.front && shift >= narrowest_shift(all.front, all.inner_back) &&
           shift <= narrowest_shift(all.front, all.outer_back) && (cell.y & least) == least && (cell.y & ~most) == 0;
}

void expect_cells(const Pyramid& pyramid, const GBufferImage& image, const TraceSettings& settings, int kind)
{
    ASSERT_EQ(pyramid_levels(pyramid.size_px), expected_levels(pyramid.size_px));
    size_t wrong = 0;
    for (int level = 1; level <= pyramid_levels(pyramid.size_px); ++level)
        for (const auto [i, x, y] : pixels_of(pyramid.size(level))) {
            const glm::uvec2 cell = pyramid.at(level, x, y);
            if (!is_right(cell, image, settings, kind, level, x, y) && wrong++ < 3)
                ADD_FAILURE() << fmt::format("{}x{}, kind {}: level {}, cell ({}, {}): nearest {} ({:08x}), bins of "
                                             "2^{}: {:08x}",
                                             pyramid.size_px.x, pyramid.size_px.y, kind, level, x, y,
                                             std::bit_cast<float>(cell.x), cell.x, cell.x & 31, cell.y);
        }
    EXPECT_EQ(wrong, 0U);
}

class DepthPyramid : public testing::TestWithParam<glm::ivec2> {};

TEST_P(DepthPyramid, EqualsBruteForceOnRandomDepth)
{
    const Picture picture = make_picture(random_gbuffer(bench_view(GetParam()), 7));
    for (const int kind : {occupancy, minmax, nearest_only})
        for (const TraceSettings& settings : {boxes({.thickness_m = 0.1}), boxes({.thickness_m = 0}),
                                              boxes({.thickness_m = std::numeric_limits<double>::infinity()}),
                                              boxes({.thickness_m = 0.2, .thickness_relative = true})})
            expect_cells(build(picture, settings, kind), picture.image, settings, kind);
}

TEST_P(DepthPyramid, KeepsTheDepthOfEveryPixelAsLevel0)
{
    const glm::ivec2 size    = GetParam();
    const Picture    picture = make_picture(random_gbuffer(bench_view(size), 9));
    const Pyramid    pyramid = build(picture, boxes(), occupancy);
    for (const auto [i, x, y] : pixels_of(size)) {
        const float depth = picture.image.depth[at(picture.image, x, y)];
        ASSERT_EQ(pyramid.pixel(x, y),
                  std::bit_cast<uint32_t>(depth > 0 ? depth : static_cast<float>(BACKGROUND_DEPTH)))
            << size.x << "x" << size.y << ", pixel (" << x << ", " << y << ")";
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
        expect_cells(build(picture, boxes({.thickness_m = 0.1, .thickness_relative = relative}), occupancy),
                     picture.image, boxes({.thickness_m = 0.1, .thickness_relative = relative}), occupancy);
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
    const TraceSettings settings = boxes({.thickness_m = 0.3});
    EXPECT_EQ(good.image.depth, bad.image.depth);
    expect_cells(build(bad, settings, occupancy), clean, settings, occupancy);
    std::string first;
    for (const char* id : {"dda", "hiz", "linear", "linear_binary"}) {
        const Technique& t = technique(id);
        EXPECT_EQ(count_differences(trace(good, t, values_of(t), settings), trace(bad, t, values_of(t), settings),
                                    bit_equal_t, first),
                  0U)
            << id << ": " << first;
    }
    EXPECT_EQ(count_differences(trace(bad, technique("hiz"), values_of(technique("hiz")), settings),
                                trace(bad, technique("dda"), values_of(technique("dda")), settings), bit_equal_t,
                                first),
              0U)
        << first;
}

} // namespace
} // namespace ssrlab::test
