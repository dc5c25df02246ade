// Procedural surfaces: what they promise of roughness, and that they repeat without a seam.
#include "scene/patterns.h"
#include "test.h"

namespace ssrlab {
namespace {

int byte_of(const Texture& texture, int x, int y, int channel)
{
    return texture.rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(texture.size_px.x) + static_cast<size_t>(x)) +
                        static_cast<size_t>(channel)];
}

/// Mean difference of neighbouring columns, of the two that meet at the repeat or of two in the middle.
double step_between_columns(const Texture& texture, int left, int right, int channel)
{
    double sum = 0;
    for (int y = 0; y < texture.size_px.y; ++y)
        sum += std::abs(byte_of(texture, left, y, channel) - byte_of(texture, right, y, channel));
    return sum / texture.size_px.y;
}

double share_of_roughness(const Texture& gloss, double low, double high)
{
    size_t inside = 0;
    for (size_t i = 1; i < gloss.rgba.size(); i += 4)
        inside += gloss.rgba[i] >= 255 * low - 1 && gloss.rgba[i] <= 255 * high + 1;
    return static_cast<double>(inside) / (static_cast<double>(gloss.rgba.size()) / 4);
}

TEST(Patterns, NothingIsMetalAndColoursAreSrgb)
{
    for (const Pattern pattern :
         {Pattern::wet_asphalt, Pattern::marble, Pattern::oak, Pattern::brick, Pattern::concrete}) {
        const PatternTextures made = make_pattern(pattern);
        EXPECT_TRUE(made.base_colour.srgb);
        EXPECT_FALSE(made.gloss.srgb);
        for (size_t i = 2; i < made.gloss.rgba.size(); i += 4) ASSERT_EQ(made.gloss.rgba[i], 0);
    }
}

TEST(Patterns, PuddlesAreSmoothAndTheRestIsRough)
{
    const Texture gloss = make_pattern(Pattern::wet_asphalt).gloss;
    EXPECT_NEAR(share_of_roughness(gloss, 0, 0.02), 0.33, 0.15);
    EXPECT_GT(share_of_roughness(gloss, 0.4, 1), 0.5);
}

TEST(Patterns, MarbleIsPolishedBesidesItsJoints)
{
    const Texture gloss = make_pattern(Pattern::marble).gloss;
    EXPECT_GT(share_of_roughness(gloss, 0.05, 0.05), 0.95);
    EXPECT_NEAR(share_of_roughness(gloss, 0.6, 0.6), 0.012, 0.01);
}

TEST(Patterns, FloorsAndWallsAreAsRoughAsTheySay)
{
    EXPECT_GT(share_of_roughness(make_pattern(Pattern::oak).gloss, 0.12, 0.24), 0.9);
    EXPECT_GT(share_of_roughness(make_pattern(Pattern::brick).gloss, 0.9, 0.95), 0.99);
    EXPECT_GT(share_of_roughness(make_pattern(Pattern::concrete).gloss, 0.08, 0.3), 0.99);
}

TEST(Patterns, RepeatWithoutASeam)
{
    for (const Pattern pattern : {Pattern::wet_asphalt, Pattern::oak, Pattern::brick, Pattern::concrete}) {
        const PatternTextures made = make_pattern(pattern);
        const int             last = made.gloss.size_px.x - 1;
        for (const Texture* texture : {&made.base_colour, &made.gloss})
            EXPECT_LT(step_between_columns(*texture, last, 0, 1),
                      3 * step_between_columns(*texture, last / 2, last / 2 + 1, 1) + 2);
    }
}

TEST(Patterns, TheSameEachTime)
{
    EXPECT_EQ(make_pattern(Pattern::marble).base_colour.rgba, make_pattern(Pattern::marble).base_colour.rgba);
}

} // namespace
} // namespace ssrlab
