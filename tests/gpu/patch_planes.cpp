// The planes above patches of pixels against the pixels themselves.
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "render/frame_passes.h"
#include "shared.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

/// Rightward, downward, at the patch's first pixel.
std::vector<glm::vec3> planes_of(const Picture& picture)
{
    const Technique& hiz   = technique("hiz");
    const auto       frame = prepare_frame(device(), picture.buffers, hiz, values_of(hiz), {TraceSettings{}});
    submit(device(), [&](const vk::raii::CommandBuffer& commands) {
        record_rays(commands, frame->trace, *picture.buffers);
        record_pyramid(commands, frame->pyramid);
        record_technique(commands, frame->trace.technique, *frame->rays);
    });
    const glm::ivec2 patches = ((picture.view.size_px - 1) >> PATCH_BITS) + 1;
    return download_as<glm::vec3>(device(), picture.buffers->patch_planes, pixel_count(patches));
}

/// How far the plane lies above the front of each pixel that has one.
std::vector<float> heights_above(const Picture& picture)
{
    const std::vector<glm::vec3> planes = planes_of(picture);
    const glm::ivec2             size = picture.view.size_px, patches = ((size - 1) >> PATCH_BITS) + 1;
    std::vector<float>           heights;
    for (size_t i = 0; i < picture.image.depth.size(); ++i) {
        if (picture.image.depth[i] <= 0) continue;
        const glm::ivec2 pixel = pixel_at(i, size), patch = pixel >> PATCH_BITS;
        const glm::vec3  plane = planes.at(pixel_index(patch, patches));
        heights.push_back(glm::dot(plane, glm::vec3(pixel - (patch << PATCH_BITS), 1)) - picture.image.depth[i]);
    }
    return heights;
}

class PatchPlanes : public testing::TestWithParam<glm::ivec2> {};

TEST_P(PatchPlanes, LieAboveEveryFrontAndTouchOne)
{
    const Picture            picture = make_picture(random_gbuffer(bench_view(GetParam()), 5));
    const std::vector<float> heights = heights_above(picture);
    ASSERT_FALSE(heights.empty());
    EXPECT_GE(std::ranges::min(heights), -1e-6F);
    EXPECT_LE(std::ranges::min(heights), 1e-6F);
}

TEST_P(PatchPlanes, AreTheSurfaceWhereItIsFlat)
{
    GBufferImage image = empty_gbuffer(bench_view(GetParam()));
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, GetParam());
        image.depth[i]         = 0.25F + 0.0004F * float(pixel.x) - 0.0002F * float(pixel.y);
        image.normal_vs[i]     = {0, 0, 1};
    }
    for (const float height : heights_above(make_picture(image))) ASSERT_NEAR(height, 0, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PatchPlanes,
                         testing::Values(glm::ivec2(1, 37), glm::ivec2(97, 2), glm::ivec2(64, 64), glm::ivec2(127, 131),
                                         glm::ivec2(641, 359)),
                         [](const auto& param) { return fmt::format("{}x{}", param.param.x, param.param.y); });

TEST(PatchPlanesOfNothing, LieBelowEverything)
{
    GBufferImage image                  = empty_gbuffer(bench_view({64, 48}));
    image.depth[0]                      = 0.5F;
    const std::vector<glm::vec3> planes = planes_of(make_picture(image));
    EXPECT_EQ(planes.front().z, 0.5F);
    for (size_t i = 1; i < planes.size(); ++i) EXPECT_LT(planes[i].z, -1e29F);
}

} // namespace
} // namespace ssrlab::test
