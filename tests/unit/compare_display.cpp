// Pictures for people: exposure, AgX, pictures side by side.
#include "compare/display.h"
#include "core/error.h"
#include "test.h"

namespace ssrlab {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan      = std::numeric_limits<float>::quiet_NaN();

glm::vec3 shown(glm::vec3 radiance, const Display& display)
{
    const Image image = to_display({{1, 1}, {"R", "G", "B"}, {radiance.r, radiance.g, radiance.b}, {}}, display);
    return {image.values[0], image.values[1], image.values[2]};
}

constexpr Display agx{0, Display::Transform::agx};

Image filled(glm::ivec2 size_px, float value)
{
    return {size_px, {"R", "G", "B"}, std::vector<float>(3 * static_cast<size_t>(size_px.x * size_px.y), value), {}};
}

TEST(Display, ClipKeepsWhatFitsAndCutsTheRest)
{
    EXPECT_EQ(shown({0.25F, -1, 3}, {}), glm::vec3(0.25F, 0, 1));
    EXPECT_EQ(shown({nan, infinity, -infinity}, {}), glm::vec3(0, 1, 0));
}

TEST(Display, ExposureIsInStops)
{
    EXPECT_EQ(shown(glm::vec3(0.125F), {.exposure_ev = 2}), glm::vec3(0.5F));
    EXPECT_EQ(shown(glm::vec3(0.5F), {.exposure_ev = -1}), glm::vec3(0.25F));
    // Exposure comes before the transform.
    EXPECT_EQ(shown(glm::vec3(0.1F), {1, Display::Transform::agx}), shown(glm::vec3(0.2F), agx));
}

TEST(Display, AgxKeepsGreyGreyAndRises)
{
    float before = -1;
    for (float ev = -10; ev <= 4; ev += 0.25F) {
        const glm::vec3 grey = shown(glm::vec3(0.18F * std::exp2(ev)), agx);
        EXPECT_NEAR(grey.r, grey.g, 2e-3) << ev;
        EXPECT_NEAR(grey.b, grey.g, 2e-3) << ev;
        EXPECT_GE(grey.g, before) << ev;
        before = grey.g;
    }
}

/// Middle grey is encoded as 0.5 (with a power of 2.2), black as black; 4.026 stops over 1 is about white, and nothing is above 1.
TEST(Display, AgxHasTheEndsThatItsAuthorGives)
{
    EXPECT_NEAR(shown(glm::vec3(0.18F), agx).g, std::pow(0.5F, 2.2F), 0.01F);
    EXPECT_LT(shown(glm::vec3(0), agx).g, 1e-4F);
    EXPECT_GT(shown(glm::vec3(16.3F), agx).g, 0.95F);
    for (const float bright : {1e3F, 1e9F, infinity}) {
        EXPECT_GT(shown(glm::vec3(bright), agx).g, 0.95F);
        EXPECT_LE(shown(glm::vec3(bright), agx).g, 1);
    }
    EXPECT_EQ(shown({nan, 1, 0.25F}, agx), glm::vec3(0, 1, 0.25F)); // clipped
}

/// The author's formulas in double precision, by hand. Without its last matrix, colours would be paler.
TEST(Display, AgxGivesColoursTheirSaturationBack)
{
    const glm::vec3 brown = shown({0.5F, 0.25F, 0.125F}, agx);
    EXPECT_NEAR(brown.r, 0.441499F, 1e-4F);
    EXPECT_NEAR(brown.g, 0.279311F, 1e-4F);
    EXPECT_NEAR(brown.b, 0.168905F, 1e-4F);
}

/// Clipping turns a bright orange yellow; AgX takes it toward white and keeps red above green above blue on the way.
TEST(Display, AgxKeepsTheHueOfBrightColours)
{
    const glm::vec3 orange = shown({16, 6, 1}, agx), clipped = shown({16, 6, 1}, {});
    EXPECT_EQ(clipped.r, clipped.g);
    EXPECT_GT(orange.r, orange.g + 0.02F);
    EXPECT_GT(orange.g, orange.b + 0.02F);
}

TEST(Display, MeansOfPictures)
{
    Image sum;
    add_to(sum, filled({2, 1}, 0.25F));
    add_to(sum, filled({2, 1}, 0.75F));
    EXPECT_THAT(mean_of(sum, 2).values, testing::Each(0.5F));
    EXPECT_THROW(add_to(sum, filled({3, 1}, 0)), Failure);
}

TEST(Display, SideBySideKeepsEveryPixelBelowTheLabels)
{
    const std::vector<LabelledImage> pictures = {{"left", filled({40, 20}, 0.25F)}, {"right", filled({40, 20}, 0.75F)}};
    const Image                      both     = side_by_side(pictures);
    ASSERT_EQ(both.size_px.x, 80);
    const int strip_px = both.size_px.y - 20;
    ASSERT_GT(strip_px, 0);
    const auto value = [&](int x, int y) { return both.values[3 * static_cast<size_t>(y * both.size_px.x + x)]; };
    for (int y = strip_px; y < both.size_px.y; ++y)
        for (int x = 0; x < 80; ++x) EXPECT_EQ(value(x, y), x < 40 ? 0.25F : 0.75F) << x << " " << y;
    for (const int first : {0, 40}) {
        float brightest = 0;
        for (int y = 0; y < strip_px; ++y)
            for (int x = first; x < first + 40; ++x) brightest = std::max(brightest, value(x, y));
        EXPECT_GT(brightest, 0.5F) << "no label above " << first;
    }
    EXPECT_THROW(side_by_side(std::vector<LabelledImage>{pictures[0], {"", filled({40, 21}, 0)}}), Failure);
}

} // namespace
} // namespace ssrlab
