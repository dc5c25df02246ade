// C = C_frag + (C_reflect - C_frag) * beta against the formula, for every switch.
#include "core/pixel_index.h"
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

double viewer_weight(ViewerFade fade, double away, double start)
{
    switch (fade) {
    case ViewerFade::off: return 1;
    case ViewerFade::linear: return std::max(0.0, away);
    case ViewerFade::cut: return away > 0 ? 1 : 0;
    case ViewerFade::smooth: break;
    }
    return std::clamp((away - start) / (1 - start), 0.0, 1.0);
}

constexpr double border_width = 0.1;

double edge_weight(EdgeFade fade, glm::dvec2 offset)
{
    const double radial = std::clamp(2 * glm::length(offset), 0.0, 1.0);
    switch (fade) {
    case EdgeFade::off: return 1;
    case EdgeFade::manhattan: return std::clamp(1 - std::abs(offset.x) - std::abs(offset.y), 0.0, 1.0);
    case EdgeFade::linear: return 1 - radial;
    case EdgeFade::border: {
        const double inside =
            std::clamp((0.5 - std::max(std::abs(offset.x), std::abs(offset.y))) / border_width, 0.0, 1.0);
        return inside * inside * (3 - 2 * inside);
    }
    case EdgeFade::squared: break;
    }
    return 1 - radial * radial;
}

double beta(const GBufferImage& image, const TraceResult& result, size_t i, const ParameterValues& passes)
{
    const glm::ivec2 pixel(static_cast<int>(i) % 64, static_cast<int>(i) / 64);
    const double     exponent = passes.at("metallic_exponent");
    double           value    = exponent > 0 ? std::pow(static_cast<double>(image.metallic[i]), exponent) : 1;
    const double     away     = -mirror_direction_vs(image, pixel).z;
    const glm::dvec2 offset   = glm::dvec2(result.hit_px_depth[i]) / 64.0 - 0.5;
    const double     viewer   = viewer_weight(choice<ViewerFade>(passes), away, passes.at("viewer_fade_start"));
    const double     edge     = edge_weight(choice<EdgeFade>(passes), offset);
    const double     most     = 1 - passes.at("base_colour_min_weight");
    value *=
        choice<FadeOperator>(passes) == FadeOperator::product ? viewer * edge * most : std::min({viewer, edge, most});
    return value;
}

class Shading : public testing::TestWithParam<ParameterValues> {};

TEST_P(Shading, IsTheFormulaAtEveryPixel)
{
    const Picture       picture = make_picture(coloured());
    const TraceSettings settings{.thickness_m = 0.5, .max_distance_m = 50};
    ParameterValues     passes   = report_passes();
    passes.at("edge_fade_width") = border_width;
    for (const auto& [name, value] : GetParam()) passes.at(name) = value;
    const auto frame =
        prepare_frame(device(), picture.buffers, technique("hiz"), values_of(technique("hiz")), {settings, passes});
    const TraceResult result = count_frame(device(), *frame);
    run_frame(device(), *frame);
    const Image shaded = read_shaded(device(), *frame);
    size_t      hits   = 0;
    for (size_t i = 0; i < result.status.size(); ++i) {
        glm::dvec3 expected = glm::dvec3(picture.image.radiance[i]) + glm::dvec3(picture.image.highlight[i]);
        // What is kept in half precision: the pixel's own light in two parts, the reflection, its weight, and the picture.
        glm::dvec3 rounded = expected;
        if (result.status[i] == TraceStatus::hit) {
            ++hits;
            const auto       from = pixel_index(result.hit_pixel[i], result.size_px);
            const glm::dvec3 reflected =
                picture.image.radiance[from]; // without the highlight: that belongs to the camera's direction
            const glm::dvec3 change = (reflected - expected) * beta(picture.image, result, i, passes);
            rounded += reflected * beta(picture.image, result, i, passes) + glm::abs(change);
            expected += change;
        }
        rounded += expected;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(static_cast<double>(shaded.values[3 * i + static_cast<size_t>(c)]), expected[c],
                        0x1p-11 * rounded[c] + 1e-5)
                << "pixel " << i << ", channel " << c;
    }
    EXPECT_GT(hits, 300U);
}

INSTANTIATE_TEST_SUITE_P(
    Settings, Shading,
    testing::Values(ParameterValues{},
                    ParameterValues{{"metallic_exponent", 0}, chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{chosen(ViewerFade::off), chosen(EdgeFade::border)},
                    ParameterValues{{"metallic_exponent", 1.5}, chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{{"metallic_exponent", 0}, chosen(ViewerFade::linear), chosen(EdgeFade::off)},
                    ParameterValues{{"metallic_exponent", 0}, chosen(ViewerFade::cut), chosen(EdgeFade::manhattan)},
                    ParameterValues{chosen(ViewerFade::smooth), {"viewer_fade_start", 0.4}, chosen(EdgeFade::linear)},
                    // Litheon's blending: the smaller weight, at most 0.4.
                    ParameterValues{chosen(ViewerFade::smooth),
                                    chosen(EdgeFade::squared),
                                    chosen(FadeOperator::minimum),
                                    {"base_colour_min_weight", 0.6}},
                    ParameterValues{{"skip_unneeded_passes", 0}, {"metallic_exponent", 2}}));

// Nothing hit, nothing changed: the lit colour to the last bit, also of pixels that are no surface.
TEST(ShadingOfMisses, LeavesTheLitColour)
{
    const Picture       picture = make_picture(coloured());
    const TraceSettings settings{.thickness_m = 0, .max_distance_m = 0.001};
    const auto          frame =
        prepare_frame(device(), picture.buffers, technique("dda"), values_of(technique("dda")), {settings});
    run_frame(device(), *frame);
    const Image shaded = read_shaded(device(), *frame);
    for (size_t i = 0; i < picture.image.depth.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(shaded.values[3 * i + static_cast<size_t>(c)],
                        picture.image.radiance[i][c] + picture.image.highlight[i][c], 1e-3F);
}

} // namespace
} // namespace ssrlab::test
