// C = C_frag + (C_reflect - C_frag) * beta against the formula, for every switch.
#include "gpu/device.h"
#include "truth/screen_ray.h"
#include "unit/truth_gbuffers.h"

#include <cmath>

namespace ssrlab::test {
namespace {

/// Floor and wall with a different colour in every pixel.
GBufferImage coloured()
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 10);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            image.radiance[at(image, x, y)]  = {static_cast<float>(x) / 64, static_cast<float>(y) / 64, 0.25F};
            image.highlight[at(image, x, y)] = {0, 0.5F, static_cast<float>(x % 4) / 4};
            if (image.metallic[at(image, x, y)] > 0) image.metallic[at(image, x, y)] = x % 2 == 0 ? 0.75F : 1.0F;
        }
    return image;
}

double beta(const GBufferImage& image, const TraceResult& result, size_t i, const ShadeSettings& shade)
{
    const glm::ivec2 pixel(static_cast<int>(i) % 64, static_cast<int>(i) / 64);
    double           value =
        shade.metallic_exponent > 0 ? std::pow(static_cast<double>(image.metallic[i]), shade.metallic_exponent) : 1;
    if (shade.fade_to_viewer) value *= std::max(0.0, -mirror_direction_vs(image, pixel).z);
    const glm::dvec2 uv = glm::dvec2(result.hit_px_depth[i]) / 64.0;
    if (shade.fade_at_edges) value *= std::clamp(1 - std::abs(uv.x - 0.5) - std::abs(uv.y - 0.5), 0.0, 1.0);
    return value;
}

class Shading : public testing::TestWithParam<ShadeSettings> {};

TEST_P(Shading, IsTheFormulaAtEveryPixel)
{
    const Picture       picture = make_picture(coloured());
    const TraceSettings settings{.thickness_m = 0.5, .max_distance_m = 50};
    const auto          frame =
        prepare_frame(device(), picture.buffers, technique("hiz"), values_of(technique("hiz")), {settings, GetParam()});
    const TraceResult result = count_frame(device(), *frame);
    run_frame(device(), *frame);
    const Image shaded = read_shaded(device(), *frame);
    size_t      hits   = 0;
    for (size_t i = 0; i < result.status.size(); ++i) {
        glm::dvec3 expected = glm::dvec3(picture.image.radiance[i]) + glm::dvec3(picture.image.highlight[i]);
        if (result.status[i] == TraceStatus::hit) {
            ++hits;
            const auto       from = static_cast<size_t>(result.hit_pixel[i].y * 64 + result.hit_pixel[i].x);
            const glm::dvec3 reflected =
                picture.image.radiance[from]; // without the highlight: that belongs to the camera's direction
            expected += (reflected - expected) * beta(picture.image, result, i, GetParam());
        }
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(static_cast<double>(shaded.values[3 * i + static_cast<size_t>(c)]), expected[c],
                        2e-3 * expected[c] + 1e-4)
                << "pixel " << i << ", channel " << c;
    }
    EXPECT_GT(hits, 300U);
}

INSTANTIATE_TEST_SUITE_P(Switches, Shading,
                         testing::Values(ShadeSettings{}, ShadeSettings{0, false, false},
                                         ShadeSettings{3, false, false}, ShadeSettings{1.5, false, false},
                                         ShadeSettings{0, true, false}, ShadeSettings{0, false, true},
                                         ShadeSettings{2, true, true}));

// Nothing hit, nothing changed: the lit colour to the last bit, also of pixels that are no surface.
TEST(ShadingOfMisses, LeavesTheLitColour)
{
    const Picture       picture = make_picture(coloured());
    const TraceSettings settings{.thickness_m = 0, .max_distance_m = 0.001};
    const auto          frame =
        prepare_frame(device(), picture.buffers, technique("dda"), values_of(technique("dda")), {settings, {}});
    run_frame(device(), *frame);
    const Image shaded = read_shaded(device(), *frame);
    for (size_t i = 0; i < picture.image.depth.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(shaded.values[3 * i + static_cast<size_t>(c)],
                        picture.image.radiance[i][c] + picture.image.highlight[i][c], 1e-3F);
}

} // namespace
} // namespace ssrlab::test
