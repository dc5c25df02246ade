// The ground of patches of pixels, and what stands before it, against the pixels themselves.
#include "core/files.h"
#include "core/pixel_index.h"
#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "shared.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

constexpr int patch_px = 16; // techniques/structures/patch_planes/structure.toml

/// Of each patch: the plane's slope rightward and downward, its depth at the first pixel; the farthest depth of its occluders, or 0.
std::vector<glm::vec4> planes_of(const Picture& picture, const TraceSettings& settings = boxes(),
                                 const Technique& reads = technique("hiz_packets"))
{
    const auto frame = prepared_frame(picture.buffers, reads, values_of(reads), {settings});
    submit(device(), [&](const Commands& commands) { record_depth_structures(commands, *frame->inputs.lab); });
    const glm::ivec2 patches = (picture.view.size_px - 1) / patch_px + 1;
    for (const auto& [name, buffer] : *picture.buffers->gbuffer->structures)
        if (name.ends_with(".planes")) return download_as<glm::vec4>(device(), buffer, pixel_count(patches));
    throw std::logic_error("no patch planes");
}

struct Front {
    size_t patch;
    float  depth;
    float  height; // of the plane above it
};

std::vector<Front> fronts_of(const Picture& picture, const std::vector<glm::vec4>& planes)
{
    const glm::ivec2   size = picture.view.size_px, patches = (size - 1) / patch_px + 1;
    std::vector<Front> fronts;
    for (size_t i = 0; i < picture.image.depth.size(); ++i) {
        const float depth = picture.image.depth[i];
        if (depth <= 0) continue;
        const glm::ivec2 pixel = pixel_at(i, size), place = pixel / patch_px;
        const size_t     patch = pixel_index(place, patches);
        const glm::vec3  plane = planes.at(patch);
        fronts.push_back({patch, depth, glm::dot(plane, glm::vec3(pixel - (place * patch_px), 1)) - depth});
    }
    return fronts;
}

/// A ground that gets nearer downward; every seventh column a bar.
GBufferImage ground_behind_bars(glm::ivec2 size_px)
{
    GBufferImage image = empty_gbuffer(bench_view(size_px));
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, size_px);
        image.depth[i]         = 0.05F + 0.0004F * float(pixel.y) / float(size_px.y) + (pixel.x % 7 == 0 ? 0.1F : 0);
        image.normal_vs[i]     = {0, 0, 1};
    }
    return image;
}

class PatchPlanes : public testing::TestWithParam<glm::ivec2> {};

TEST_P(PatchPlanes, NoFrontLiesAboveButWhatStandsBefore)
{
    const Picture           picture = make_picture(random_gbuffer(bench_view(GetParam()), 5));
    const auto              planes  = planes_of(picture);
    std::map<size_t, float> least, farthest;
    for (const Front& front : fronts_of(picture, planes)) {
        if (front.height < -1e-6F) {
            ASSERT_GT(planes[front.patch].w, 0) << "patch " << front.patch;
            ASSERT_GE(front.depth, planes[front.patch].w) << "patch " << front.patch;
            const auto entry = farthest.try_emplace(front.patch, front.depth).first;
            entry->second    = std::min(entry->second, front.depth);
        } else {
            const auto entry = least.try_emplace(front.patch, front.height).first;
            entry->second    = std::min(entry->second, front.height);
        }
    }
    ASSERT_FALSE(least.empty());
    for (const auto& [patch, height] : least) EXPECT_LE(height, 1e-6F) << "patch " << patch;
    for (const auto& [patch, depth] : farthest) EXPECT_EQ(depth, planes[patch].w) << "patch " << patch;
}

TEST_P(PatchPlanes, AreTheSurfaceWhereItIsFlat)
{
    GBufferImage image = empty_gbuffer(bench_view(GetParam()));
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, GetParam());
        image.depth[i]         = 0.25F + 0.0004F * float(pixel.x) - 0.0002F * float(pixel.y);
        image.normal_vs[i]     = {0, 0, 1};
    }
    const Picture picture = make_picture(image);
    const auto    planes  = planes_of(picture);
    for (const Front& front : fronts_of(picture, planes)) ASSERT_NEAR(front.height, 0, 1e-6);
    for (const glm::vec4& plane : planes) ASSERT_EQ(plane.w, 0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PatchPlanes,
                         testing::Values(glm::ivec2(1, 37), glm::ivec2(97, 2), glm::ivec2(64, 64), glm::ivec2(127, 131),
                                         glm::ivec2(101, 17), glm::ivec2(641, 359)),
                         [](const auto& param) { return fmt::format("{}x{}", param.param.x, param.param.y); });

TEST(PatchPlanesBehindBars, AreTheGround)
{
    const Picture       picture  = make_picture(ground_behind_bars({128, 64}));
    const TraceSettings settings = boxes({.thickness_m = 0.1});
    const auto          planes   = planes_of(picture, settings);
    for (const Front& front : fronts_of(picture, planes)) {
        if (front.depth > 0.1F)
            ASSERT_GE(front.depth, planes[front.patch].w);
        else
            ASSERT_NEAR(front.height, 0, 1e-7);
    }
    for (const glm::vec4& plane : planes) ASSERT_NEAR(plane.w, 0.15F, 0.0005F);
}

TEST(PatchPlanesBehindBars, LieAboveThemWhereSlabsNeverEnd)
{
    const Picture       picture  = make_picture(ground_behind_bars({128, 64}));
    const TraceSettings settings = boxes({.thickness_m = std::numeric_limits<double>::infinity()});
    const auto          planes   = planes_of(picture, settings);
    for (const Front& front : fronts_of(picture, planes)) ASSERT_GE(front.height, -1e-6F);
    for (const glm::vec4& plane : planes) ASSERT_EQ(plane.w, 0);
}

TEST(PatchPlanesBehindBars, LieAboveThemWherePacketsStayInFront)
{
    const Picture               picture   = make_picture(ground_behind_bars({128, 64}));
    const TraceSettings         settings  = boxes({.thickness_m = 0.1});
    const std::filesystem::path folders[] = {data_root() / "techniques/rivals"};
    const Catalogue             all       = load_catalogue(folders);
    const auto                  planes = planes_of(picture, settings, find_technique(all.techniques, "first_occluder"));
    for (const Front& front : fronts_of(picture, planes)) ASSERT_GE(front.height, -1e-6F);
    for (const glm::vec4& plane : planes) ASSERT_EQ(plane.w, 0);
}

TEST(PatchPlanesOfNothing, LieBelowEverything)
{
    GBufferImage image                  = empty_gbuffer(bench_view({64, 48}));
    image.depth[0]                      = 0.5F;
    const std::vector<glm::vec4> planes = planes_of(make_picture(image));
    EXPECT_EQ(planes.front().z, 0.5F);
    for (size_t i = 1; i < planes.size(); ++i) EXPECT_LT(planes[i].z, -1e29F);
}

} // namespace
} // namespace ssrlab::test
