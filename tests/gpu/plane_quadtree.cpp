// The plane quadtree against the pixels themselves: every pixel's slab lies in every node above it, at every place of the pixel.
#include "core/pixel_index.h"
#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "shared.h"
#include "truth/screen_truth.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

/// techniques/structures/plane_quadtree/node.glsl
struct Node {
    glm::vec2 gradient;
    double    low, high;
    uint32_t  bins;

    double bin_height() const { return (high - low) / 32; }
};

struct Quadtree {
    glm::ivec2              size_px;
    std::vector<glm::uvec4> nodes;

    Node at(int level, glm::ivec2 pixel) const
    {
        const auto index = static_cast<size_t>(((pyramid_root(size_px) | pixel.y) >> level) * level_size(size_px, 1).x +
                                               (pixel.x >> level));
        const glm::uvec4 words = nodes.at(index);
        return {{std::bit_cast<float>(words.x & 0xFFFF0000U), std::bit_cast<float>(words.x << 16)},
                std::bit_cast<float>(words.y),
                std::bit_cast<float>(words.z),
                words.w};
    }
};

Quadtree build(const Picture& picture, const TraceSettings& settings, const ParameterValues& changed = {})
{
    const Technique& reads                = technique("quadtree");
    ParameterValues  values               = values_of(reads, changed);
    values.at("plane_quadtree.top_level") = 14;
    const auto frame                      = prepared_frame(picture.buffers, reads, values, {settings});
    submit(device(), [&](const Commands& commands) { record_depth_structures(commands, *frame->inputs.lab); });
    const Buffer& nodes = picture.buffers->gbuffer->structures->at("plane_quadtree.nodes");
    return {picture.view.size_px, download_as<glm::uvec4>(device(), nodes, nodes.bytes / sizeof(glm::uvec4))};
}

/// The heights of a pixel's slab above a node's plane, over the whole pixel.
struct Heights {
    double low, high;
};

Heights heights_in(const Node& node, glm::dvec2 centre_px, glm::ivec2 pixel, double front, double back)
{
    const glm::dvec2 gradient(node.gradient), from_centre = glm::dvec2(pixel) + 0.5 - centre_px;
    const double middle = glm::dot(gradient, from_centre), spread = (std::abs(gradient.x) + std::abs(gradient.y)) / 2;
    return {back - middle - spread, front - middle + spread};
}

bool holds(const Node& node, const Heights& heights)
{
    if (node.bins == 0 || heights.low < node.low || heights.high > node.high) return false;
    const auto bin_of = [&](double height) {
        return std::clamp(static_cast<int>(std::floor((node.high - height) / node.bin_height())), 0, 31);
    };
    for (int bin = bin_of(heights.high); bin <= bin_of(heights.low); ++bin)
        if ((node.bins >> bin & 1U) == 0) return false;
    return true;
}

void expect_every_slab_held(const Picture& picture, const TraceSettings& settings, const ParameterValues& changed = {})
{
    const Quadtree   tree = build(picture, settings, changed);
    const ScreenWalk walk(picture.image, settings);
    const glm::ivec2 size = picture.view.size_px;
    for (int level = 1; level <= pyramid_levels(size); ++level) {
        std::vector<bool> occupied(pixel_count(level_size(size, level)));
        for (size_t i = 0; i < picture.image.depth.size(); ++i) {
            const double front = picture.image.depth[i];
            if (front <= 0) continue;
            const glm::ivec2 pixel = pixel_at(i, size), cell = pixel >> level;
            const glm::dvec2 centre_px = (glm::dvec2(cell) + 0.5) * double(1 << level);
            const Node       node      = tree.at(level, pixel);
            const Heights heights = heights_in(node, centre_px, pixel, front, slab_back(picture.view, front, settings));
            ASSERT_TRUE(holds(node, heights))
                << "level " << level << ", pixel " << pixel.x << " " << pixel.y << ": heights " << heights.low << " to "
                << heights.high << ", node " << node.low << " to " << node.high << ", bins " << node.bins;
            occupied[pixel_index(cell, level_size(size, level))] = true;
        }
        for (size_t i = 0; i < occupied.size(); ++i)
            ASSERT_EQ(tree.at(level, pixel_at(i, level_size(size, level)) << level).bins != 0, occupied[i])
                << "level " << level << ", cell " << i;
    }
}

class PlaneQuadtree : public testing::TestWithParam<glm::ivec2> {};

TEST_P(PlaneQuadtree, HoldsEverySlabOfNoise)
{
    const Picture       picture = make_picture(random_gbuffer(bench_view(GetParam()), 5));
    const TraceSettings thin    = boxes({.thickness_m = 0.001}),
                        thick   = boxes({.thickness_m = 0.3, .thickness_relative = true}),
                        endless = boxes({.thickness_m = std::numeric_limits<double>::infinity()});
    for (const TraceSettings& settings : {thin, thick, endless})
        for (const double planes : {0, 1})
            for (const double bins : {0, 1})
                expect_every_slab_held(picture, settings,
                                       {{"plane_quadtree.planes", planes}, {"plane_quadtree.bins", bins}});
}

TEST_P(PlaneQuadtree, HoldsEverySlabOfScenes)
{
    for (const char* scene : {"thin_yard", "interior", "builtin:everything"})
        for (const double thickness_m : {0.1, 0.001})
            expect_every_slab_held(make_picture(scene, "default", GetParam()), boxes({.thickness_m = thickness_m}));
}

INSTANTIATE_TEST_SUITE_P(Sizes, PlaneQuadtree,
                         testing::Values(glm::ivec2(1, 37), glm::ivec2(97, 1), glm::ivec2(64, 64), glm::ivec2(127, 131),
                                         glm::ivec2(641, 359)),
                         [](const auto& param) { return fmt::format("{}x{}", param.param.x, param.param.y); });

TEST(PlaneQuadtreeOfAnOrthographicView, HoldsEverySlab)
{
    View view             = bench_view({101, 67});
    view.projection       = Projection::orthographic;
    view.far_m            = 10;
    const Picture picture = make_picture(random_gbuffer(view, 3));
    for (const double thickness_m : {0.01, 20.0}) expect_every_slab_held(picture, boxes({.thickness_m = thickness_m}));
}

TEST(PlaneQuadtreeOfAFlatSurface, FollowsIt)
{
    const glm::dvec2 gradient{0.0004, -0.0002};
    GBufferImage     image = empty_gbuffer(bench_view({256, 128}));
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, image.view.size_px);
        image.depth[i]         = static_cast<float>(0.25 + glm::dot(gradient, glm::dvec2(pixel)));
        image.normal_vs[i]     = {0, 0, 1};
    }
    const TraceSettings settings = boxes({.thickness_m = 0.0001});
    const Quadtree      tree     = build(make_picture(image), settings);
    for (const int level : {2, 4, 7}) {
        const Node node = tree.at(level, {0, 0});
        EXPECT_NEAR(node.gradient.x, gradient.x, 2e-6) << level;
        EXPECT_NEAR(node.gradient.y, gradient.y, 2e-6) << level;
        // A pixel is as deep as the surface's rise over it and its slab; a level plane's band would be as deep as the rise over the cell.
        EXPECT_LT(node.high - node.low, 0.0025) << level;
    }
}

// The surface rises by about a last place of its depth from one pixel to the next, so that the heights of slabs round.
TEST(PlaneQuadtreeOfTheLastPlaces, HoldsEverySlab)
{
    for (const glm::dvec2& slope : {glm::dvec2(1.3, 0.7), glm::dvec2(-0.6, 2.2), glm::dvec2(5.1, -3.4)}) {
        GBufferImage image = empty_gbuffer(bench_view({128, 128}));
        for (size_t i = 0; i < image.depth.size(); ++i) {
            const glm::dvec2 from_middle = glm::dvec2(pixel_at(i, image.view.size_px)) - 64.0;
            image.depth[i]     = static_cast<float>(0.75 + std::floor(glm::dot(slope, from_middle)) / (1 << 24));
            image.normal_vs[i] = {0, 0, 1};
        }
        expect_every_slab_held(make_picture(image), boxes({.thickness_m = 1e-9}));
    }
}

// Found by a search: the heights of nodes round below those of their slabs.
TEST(PlaneQuadtreeOfTheLastPlaces, HoldsSlabsThatRoundAway)
{
    constexpr int places[] = {5, 5, 3, 1, 0, -1, -2, -5};
    GBufferImage  image    = empty_gbuffer(bench_view({64, 64}));
    for (size_t i = 0; i < image.depth.size(); ++i) {
        image.depth[i]     = 0.5F + static_cast<float>(places[i % 8]) / (1 << 24);
        image.normal_vs[i] = {0, 0, 1};
    }
    expect_every_slab_held(make_picture(image), boxes({.thickness_m = 1e-9}));
}

TEST(PlaneQuadtreeOfNothing, IsEmpty)
{
    GBufferImage image  = empty_gbuffer(bench_view({64, 48}));
    image.depth[0]      = 0.5F;
    const Quadtree tree = build(make_picture(image), boxes({.thickness_m = 0.1}));
    for (int level = 1; level <= 6; ++level) {
        EXPECT_NE(tree.at(level, {0, 0}).bins, 0U);
        EXPECT_EQ(tree.at(level, {40, 40}).bins != 0, level == 6);
    }
}

} // namespace
} // namespace ssrlab::test
