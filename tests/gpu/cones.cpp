// Cone tracing: what cones look up, and what they make of pictures whose answers are known.
#include "gpu/passes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ssrlab::test {
namespace {

/// The visibility of cells after the pass ran on 4 x 4 pixels at these distances in metres; 0: background.
class Visibility {
public:
    explicit Visibility(const std::array<double, 16>& distances_m)
    {
        GBufferImage image = empty_gbuffer(bench_view({4, 4}));
        for (int i = 0; i < 16; ++i)
            if (distances_m.at(i) > 0) set_pixel(image, i % 4, i / 4, distances_m.at(i), {0, 0, 1}, 1);
        const Picture picture = make_picture(image);
        const auto    frame   = frame_with(picture, {chosen(Gloss::cone), {"skip_unneeded_passes", 0}});
        run_pass(*frame, cone_pyramid_pass());
        const GpuImage& image_of_cells = picture.buffers->cone->cells;
        cells_                         = read_colours(image_of_cells);
        width_                         = image_of_cells.size_px.x;
    }
    float operator()(int level, int x, int y) const
    {
        return cells_[size_t((pyramid_root({4, 4}) >> level) + y) * size_t(width_) + size_t(x)].a;
    }

private:
    Reflection cells_;
    int        width_;
};

TEST(Cones, VisibilityIsTheEmptyShareOfEachCellsRange)
{
    const Visibility cell({1, 2, 2, 2, //
                           3, 3, 2, 2, //
                           4, 4, 5, 0, //
                           8, 6, 0, 0});
    // Level 1. From 1 to 3 m: 0, 1/2, 1 and 1 are empty in front of the four pixels.
    EXPECT_NEAR(cell(1, 0, 0), 0.625, 1e-3);
    EXPECT_NEAR(cell(1, 1, 0), 1, 1e-3);     // flat
    EXPECT_NEAR(cell(1, 0, 1), 0.375, 1e-3); // from 4 to 8 m: 0, 0, 1 and 1/2
    EXPECT_NEAR(cell(1, 1, 1), 0.75, 1e-3);  // nothing is behind infinity
    // Level 2: before infinity all that is finite is near.
    EXPECT_NEAR(cell(2, 0, 0), 0, 1e-3);
}

TEST(Cones, VisibilityOfHigherLevelsIsTheProductOverTheLevels)
{
    const Visibility cell({1, 2, 2, 2, //
                           3, 3, 2, 2, //
                           4, 4, 5, 5, //
                           8, 6, 9, 9});
    // Level 1: 0.625, 1, 0.375, 0.5. Level 2, from 1 to 9 m: 0, 1/8, 3/8 and 1/2 are empty in front of them.
    EXPECT_NEAR(cell(2, 0, 0), (0 * 0.625 + 0.125 * 1 + 0.375 * 0.375 + 0.5 * 0.5) / 4, 1e-3);
}

/// A floor of the given roughness before a wall, where every column has the colour that `colour` says.
template <typename Colour>
Picture floor_before_wall(float roughness, const Colour& colour, glm::ivec2 size_px = {128, 128})
{
    GBufferImage image = floor_and_wall(bench_view(size_px), 4);
    std::ranges::fill(image.roughness, roughness);
    for (size_t i = 0; i < image.radiance.size(); ++i) image.radiance[i] = colour(static_cast<int>(i) % size_px.x);
    std::ranges::fill(image.highlight, glm::vec3(0.5F));
    return make_picture(image);
}

/// What hit_colour makes of the hits, without fades.
Reflection reflection_of(const Picture& picture, ParameterValues passes)
{
    passes.insert({chosen(ViewerFade::off),
                   chosen(EdgeFade::off),
                   chosen(BounceMode::off),
                   {"skip_unneeded_passes", 0},
                   {"blur_scale", 0}});
    const auto frame = frame_with(picture, passes);
    run_frame(device(), *frame);
    return read_colours(picture.buffers->reflection);
}

TEST(Cones, LeaveSmoothSurfacesToTheLastBit)
{
    const Picture picture =
        floor_before_wall(0, [](int x) { return glm::vec3(static_cast<float>(x * 7919 % 256) / 256); });
    const Reflection cones = reflection_of(picture, {chosen(Gloss::cone)});
    EXPECT_GT(std::ranges::count_if(cones, [](const glm::vec4& pixel) { return pixel.a > 0; }), 1000);
    EXPECT_EQ(cones, reflection_of(picture, {chosen(Gloss::off)}));
}

TEST(Cones, OfOneColourSeeThatColour)
{
    const auto one_colour = [](int /*x*/) { return glm::vec3(0.25F, 0.5F, 0.75F); };
    // In a picture taller than wide the levels that cones look up lie one above the other.
    for (const glm::ivec2& size_px : {glm::ivec2(128, 128), glm::ivec2(75, 131)}) {
        const Picture picture = floor_before_wall(0.6F, one_colour, size_px);
        for (const double steps : {1, 7}) {
            for (const auto& [shading, highlight] : {std::pair(HitShading::diffuse, 0.0F), {HitShading::lit, 0.5F}}) {
                int        seen = 0;
                const auto found =
                    reflection_of(picture, {chosen(Gloss::cone), chosen(shading), {"cone_steps", steps}});
                for (const glm::vec4& pixel : found) {
                    if (pixel.a <= 0) continue;
                    ++seen;
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(pixel[c], 0.25F * static_cast<float>(c + 1) + highlight, 1e-3F);
                }
                EXPECT_GT(seen, 1000);
            }
        }
    }
}

// Across the border of two colours a circle holds of each what lies on its side. Interpolated cells as wide as the circle in the cone cover
// about a circle twice as wide.
TEST(Cones, OverTwoColoursMixThemByTheirShareOfTheCone)
{
    constexpr int    border = 64, row = 110;
    constexpr double scale = 0.5, roughness = 0.5;
    const Picture    picture = floor_before_wall(
           static_cast<float>(roughness), [](int x) { return x < border ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0); });
    const Reflection found = reflection_of(
        picture, {chosen(Gloss::cone), chosen(HitShading::diffuse), {"cone_steps", 1}, {"cone_scale", scale}});
    // The mirror ray of a floor pixel stays in its column: from slope s below the horizon to 2 / 4 m - s.
    const double height = 2 * (row + 0.5 - 64 - 64 / 4.0);
    const double alpha2 = std::pow(roughness, 4);
    const double sine   = std::sin(scale * std::acos(std::pow(0.244, alpha2 / (2 - alpha2))));
    const double radius = height * sine / (1 + sine);
    EXPECT_GT(radius, 5);
    for (int x = 0; x < 128; ++x) {
        const glm::vec4& pixel = found[at(picture.image, x, row)];
        ASSERT_EQ(pixel.a, 1) << x;
        EXPECT_NEAR(pixel.r + pixel.g, 1, 2e-3) << x;
        const double u = std::clamp((x + 0.5 - border) / (2 * radius), -1.0, 1.0);
        EXPECT_NEAR(pixel.r, 0.5 - (std::asin(u) + u * std::sqrt(1 - u * u)) / std::numbers::pi, 0.1) << x;
    }
    EXPECT_NEAR(found[at(picture.image, border - 1, row)].r + found[at(picture.image, border, row)].r, 1, 0.01);
}

} // namespace
} // namespace ssrlab::test
