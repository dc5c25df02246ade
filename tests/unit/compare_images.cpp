// RMSE, PSNR, SSIM and FLIP where the answer is known.
#include "compare/flip.h"
#include "compare/measures.h"
#include "compare/ssim.h"
#include "core/error.h"
#include "core/pixel_index.h"
#include "test.h"

namespace ssrlab {
namespace {

Image uniform(glm::ivec2 size_px, glm::vec3 colour)
{
    Image image;
    image.size_px  = size_px;
    image.channels = {"R", "G", "B"};
    for (int i = 0; i < size_px.x * size_px.y; ++i)
        image.values.insert(image.values.end(), {colour.r, colour.g, colour.b});
    return image;
}

Image noise(glm::ivec2 size_px, unsigned seed)
{
    Image                                 image = uniform(size_px, {0, 0, 0});
    std::mt19937                          random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (float& value : image.values) value = unit(random);
    return image;
}

Plane first_channel(const Image& image)
{
    Plane plane{image.size_px, {}};
    for (size_t i = 0; i < image.values.size(); i += 3) plane.values.push_back(image.values[i]);
    return plane;
}

float largest(const std::vector<float>& values) { return *std::max_element(values.begin(), values.end()); }
float smallest(const std::vector<float>& values) { return *std::min_element(values.begin(), values.end()); }

std::vector<float> flip_of(const Image& a, const Image& b, float pixels_per_degree = flip_pixels_per_degree)
{
    return flip_error(flip_view(a, pixels_per_degree), flip_view(b, pixels_per_degree));
}

TEST(Flip, IdenticalIsZero)
{
    const Image image = noise({37, 21}, 1);
    EXPECT_EQ(largest(flip_of(image, image)), 0);
}

// The largest difference of the paper's metric, by definition: pure green against pure blue.
TEST(Flip, GreenAgainstBlueIsOne)
{
    for (const float error : flip_of(uniform({24, 24}, {0, 1, 0}), uniform({24, 24}, {0, 0, 1})))
        EXPECT_NEAR(error, 1, 1e-4);
}

// Uniform pictures have no features: the error is the colour term alone. Black to white is 100 in L*; with cmax the 0.7th power of the
// HyAB distance of Hunt-adjusted green (87.74, -75.62, 72.98) and blue (32.30, 25.58, -34.84), 203.3^0.7 = 41.27:
// 0.95 + 0.05 (100^0.7 - 0.4 * 41.27) / (0.6 * 41.27) = 0.9674.
TEST(Flip, BlackAgainstWhite)
{
    const Image black = uniform({24, 24}, {0, 0, 0}), white = uniform({24, 24}, {1, 1, 1});
    for (const float error : flip_of(black, white)) EXPECT_NEAR(error, 0.9674F, 5e-4);
    for (const float error : flip_of(white, black)) EXPECT_NEAR(error, 0.9674F, 5e-4);
}

TEST(Flip, SymmetricAndBounded)
{
    const Image a = noise({41, 33}, 1), b = noise({41, 33}, 2);
    const auto  forward = flip_of(a, b), backward = flip_of(b, a);
    EXPECT_EQ(forward, backward);
    EXPECT_GE(smallest(forward), 0);
    EXPECT_LE(largest(forward), 1);
}

// From far away a fine checkerboard and its mean look alike.
TEST(Flip, FineDetailVanishesWithDistance)
{
    Image a = uniform({64, 64}, glm::vec3(0)), b = a;
    for (size_t i = 0; i < a.values.size() / 3; ++i) {
        const bool even = (i % 64 + i / 64) % 2 == 0;
        for (size_t c = 0; c < 3; ++c) {
            a.values[3 * i + c] = even ? 0.6F : 0.4F;
            b.values[3 * i + c] = even ? 0.4F : 0.6F;
        }
    }
    const auto at_centre = [&](float ppd) { return flip_of(a, b, ppd)[32 * 64 + 32]; };
    EXPECT_LT(at_centre(200), at_centre(20));
    EXPECT_LT(at_centre(200), 0.05F);
}

// FLIP of one pixel once more, as Andersson et al. 2020 define it: by sums over two-dimensional filters, in double precision.
namespace by_definition {

constexpr double pi = std::numbers::pi;
/// Linear RGB of every place, inside the picture or beyond.
using Colours = std::function<glm::dvec3(glm::ivec2)>;
using Filter  = std::function<double(double x_deg, double y_deg)>;

const glm::dmat3 rgb_to_xyz{
    {0.41238656, 0.21263682, 0.01933062}, {0.35759149, 0.71518298, 0.11919716}, {0.18045049, 0.0721802, 0.95037259}};
const glm::dvec3 white = rgb_to_xyz * glm::dvec3(1);

/// CIELAB with Hunt's effect.
glm::dvec3 hunt_lab(glm::dvec3 rgb)
{
    glm::dvec3 f = rgb_to_xyz * rgb / white;
    for (int c : {0, 1, 2}) f[c] = f[c] > 216.0 / 24389 ? std::cbrt(f[c]) : f[c] * 841 / 108 + 4.0 / 29;
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

double hyab(glm::dvec3 a, glm::dvec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

/// XYZ as parts of white about a pixel. The weights above 0 sum to 1, those below to -1.
glm::dvec3 filtered(const Colours& colours, glm::ivec2 pixel, int radius_px, const Filter& filter)
{
    glm::dvec3 above(0), below(0);
    double     weight_above = 0, weight_below = 0;
    for (int y = -radius_px; y <= radius_px; ++y)
        for (int x = -radius_px; x <= radius_px; ++x) {
            const double     weight = filter(x / double(flip_pixels_per_degree), y / double(flip_pixels_per_degree));
            const glm::dvec3 term   = weight * (rgb_to_xyz * colours(pixel + glm::ivec2(x, y)) / white);
            (weight > 0 ? above : below) += term;
            (weight > 0 ? weight_above : weight_below) += std::abs(weight);
        }
    return above / weight_above + (weight_below > 0 ? below / weight_below : glm::dvec3(0));
}

/// Section 4.1: Y, Cx = X - Y and Cz = Y - Z, each as sharp as the eye sees it.
glm::dvec3 perceived(const Colours& colours, glm::ivec2 pixel)
{
    const int  radius_px = 10; // three deviations of the widest
    const auto seen      = [&](const std::vector<glm::dvec2>& terms) {
        return filtered(colours, pixel, radius_px, [&](double x_deg, double y_deg) {
            double sum = 0;
            for (const glm::dvec2& term : terms)
                sum +=
                    term[0] * std::sqrt(pi / term[1]) * std::exp(-pi * pi * (x_deg * x_deg + y_deg * y_deg) / term[1]);
            return sum;
        });
    };
    const glm::dvec3 y = seen({{1, 0.0047}}), cx = seen({{1, 0.0053}}), cz = seen({{34.1, 0.04}, {13.5, 0.025}});
    const glm::dvec3 xyz = glm::dvec3(y.y + cx.x - cx.y, y.y, y.y - cz.y + cz.z) * white;
    return hunt_lab(glm::clamp(glm::inverse(rgb_to_xyz) * xyz, 0.0, 1.0));
}

/// Section 4.2: the first and the second derivative of a Gaussian, along both axes.
glm::dvec2 edge_and_point(const Colours& colours, glm::ivec2 pixel)
{
    const double deviation_deg = 0.5 * 0.082;
    const int    radius_px     = 9; // three deviations
    const auto   gauss         = [&](double x_deg, double y_deg) {
        return std::exp(-(x_deg * x_deg + y_deg * y_deg) / (2 * deviation_deg * deviation_deg));
    };
    const auto length = [&](const std::function<double(double)>& factor) {
        const auto along = [&](int axis) {
            return filtered(colours, pixel, radius_px,
                            [&](double x_deg, double y_deg) {
                                return factor((axis == 0 ? x_deg : y_deg) / deviation_deg) * gauss(x_deg, y_deg);
                            })
                .y;
        };
        return std::hypot(along(0), along(1));
    };
    return {length([](double x) { return -x; }), length([](double x) { return x * x - 1; })};
}

double flip(const Colours& tested, const Colours& reference, glm::ivec2 pixel)
{
    const double     largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7), knee = 0.4 * largest;
    const double     power    = std::pow(hyab(perceived(tested, pixel), perceived(reference, pixel)), 0.7);
    const double     colour   = power < knee ? 0.95 * power / knee : 0.95 + 0.05 * (power - knee) / (largest - knee);
    const glm::dvec2 features = glm::abs(edge_and_point(tested, pixel) - edge_and_point(reference, pixel));
    return std::pow(colour, 1 - std::sqrt(std::max(features.x, features.y) / std::numbers::sqrt2));
}

} // namespace by_definition

/// The colours, which are 0 or 1 and so the same in sRGB, as a picture.
Image picture_of(glm::ivec2 size_px, const by_definition::Colours& colours)
{
    Image image = uniform(size_px, {0, 0, 0});
    for (size_t i = 0; i < pixel_count(size_px); ++i)
        for (int c : {0, 1, 2}) image.values[3 * i + size_t(c)] = float(colours(pixel_at(i, size_px))[c]);
    return image;
}

/// In the middle, where no filter reaches the border.
void expect_flip_by_definition(const by_definition::Colours& tested, const by_definition::Colours& reference)
{
    const glm::ivec2         size_px{41, 25};
    const std::vector<float> found = flip_of(picture_of(size_px, tested), picture_of(size_px, reference));
    for (int y = 11; y < 14; ++y)
        for (int x = 11; x < 30; ++x)
            EXPECT_NEAR(found[pixel_index({x, y}, size_px)], by_definition::flip(tested, reference, {x, y}), 1e-4)
                << x << ", " << y;
}

// The eye sees blue against yellow less sharply than it sees lightness.
TEST(Flip, OfABorderOfBlueAndYellowIsThatOfItsDefinition)
{
    const glm::dvec3 blue(0, 0, 1), yellow(1, 1, 0);
    expect_flip_by_definition([&](glm::ivec2 p) { return p.x < 20 ? blue : yellow; }, [&](glm::ivec2) { return blue; });
}

// Beside a border of black and white lie the largest edges and, two pixels off, points; about a dot both.
TEST(Flip, OfEdgesAndPointsIsThatOfItsDefinition)
{
    const glm::dvec3 black(0), white(1);
    expect_flip_by_definition([&](glm::ivec2 p) { return p.x < 17 || p == glm::ivec2(24, 12) ? white : black; },
                              [&](glm::ivec2) { return black; });
}

TEST(Flip, DifferentSizesAreRefused) { EXPECT_THROW(flip_of(uniform({3, 3}, {}), uniform({4, 3}, {})), Failure); }
TEST(Flip, AnImageWithoutThreeChannelsIsRefused)
{
    EXPECT_THROW(flip_view({{2, 1}, {"Y"}, {0.5F, 0.5F}, {}}), Failure);
}

// What is left out outside a mask changes nothing inside: the same numbers as of the whole picture with the reference pasted in there.
TEST(Masks, ChangeNothingInside)
{
    const glm::ivec2 size   = {53, 31};
    const Image      tested = noise(size, 8), shown = noise(size, 9);
    Image            pasted = tested;
    Mask             mask(pixel_count(size));
    for (size_t i = 0; i < mask.size(); ++i) {
        mask[i] = (i / 7) % 3 == 0 ? 1 : 0;
        for (size_t c = 0; c < 3 && mask[i] == 0; ++c) pasted.values[3 * i + c] = shown.values[3 * i + c];
    }
    const FlipView           reference = flip_view(shown);
    const std::vector<float> whole     = flip_error(flip_view(pasted), reference);
    const std::vector<float> inside    = flip_error(flip_view_inside(tested, reference, mask), reference, mask);
    const SsimView           a = ssim_view(first_channel(pasted)), b = ssim_view(first_channel(shown));
    const std::vector<float> ssim = ssim_map(a, b), ssim_inside = ssim_map(a, b, mask);
    for (size_t i = 0; i < mask.size(); ++i) {
        EXPECT_EQ(inside[i], mask[i] != 0 ? whole[i] : 0) << i;
        EXPECT_EQ(ssim_inside[i], mask[i] != 0 ? ssim[i] : 0) << i;
    }
    EXPECT_GT(largest(inside), 0.1F);
    EXPECT_THROW(flip_view_inside(noise({5, 5}, 1), reference, mask), Failure);
    EXPECT_THROW(Reference({{2, 1}, {"Y"}, {0.5F, 0.5F}, {}}), Failure);
}

TEST(Filter, EveryWidthGivesThePlainSums)
{
    const std::vector<float> across = {0.1F, -0.4F, 0.7F, 0.2F, 0.3F}, down = {0.5F, 0.25F, -0.125F};
    for (const int width : {1, 3, 15, 16, 17, 32, 45}) {
        const glm::ivec2 size     = {width, 4};
        const Plane      plane    = first_channel(noise(size, unsigned(width)));
        const Plane      filtered = filter_separable(plane, across, down);
        for (const auto [pixel, x, y] : test::pixels_of(size)) {
            double sum = 0;
            for (size_t j = 0; j < down.size(); ++j)
                for (size_t i = 0; i < across.size(); ++i) {
                    const glm::ivec2 from = glm::clamp(glm::ivec2(x - 2 + int(i), y - 1 + int(j)), {0, 0}, size - 1);
                    sum += double(across[i]) * double(down[j]) * double(plane.values[pixel_index(from, size)]);
                }
            EXPECT_NEAR(filtered.values[pixel], sum, 1e-6) << width << ": " << x << ", " << y;
        }
    }
}

TEST(Ssim, IdenticalIsOneAndConstantsFollowTheFormula)
{
    const SsimView a = ssim_view(first_channel(noise({30, 20}, 3)));
    EXPECT_NEAR(smallest(ssim_map(a, a)), 1, 1e-5);
    // Without variance only the luminance term remains: (2 ab + c1) / (a^2 + b^2 + c1).
    const SsimView x = ssim_view(first_channel(uniform({15, 15}, glm::vec3(0.2F)))),
                   y = ssim_view(first_channel(uniform({15, 15}, glm::vec3(0.6F))));
    for (const float index : ssim_map(x, y)) EXPECT_NEAR(index, (2 * 0.12 + 1e-4) / (0.04 + 0.36 + 1e-4), 2e-3);
    const SsimView b = ssim_view(first_channel(noise({30, 20}, 4)));
    EXPECT_LT(largest(ssim_map(a, b)), 0.9F);
}

SceneTruth half_visible(glm::ivec2 size_px)
{
    SceneTruth truth;
    truth.size_px = size_px;
    for (int i = 0; i < size_px.x * size_px.y; ++i) {
        truth.cls.push_back(i % size_px.x < size_px.x / 2 ? TruthClass::visible : TruthClass::hidden);
    }
    return truth;
}

// Linear 1 against 0 on the right half only: nothing over the visible left half, 1 over half of all pixels.
TEST(ImageMeasures, MaskDecidesWhatCounts)
{
    const Image reference = uniform({40, 20}, glm::vec3(0));
    Image       tested    = reference;
    for (size_t i = 0; i < 800; ++i) {
        if (i % 40 < 20) continue;
        for (size_t c = 0; c < 3; ++c) tested.values[3 * i + c] = 1;
    }
    MeasureValues values = compare_images(tested, Reference(reference), half_visible({40, 20}));
    EXPECT_EQ(values.at("rmse_visible"), 0);
    EXPECT_FALSE(values.at("psnr_visible_db"));
    EXPECT_NEAR(values.at("ssim_visible").value(), 1, 1e-6);
    EXPECT_EQ(values.at("flip_visible"), 0);
    EXPECT_NEAR(values.at("rmse_reflective").value(), std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(values.at("psnr_reflective_db").value(), 20 * std::log10(std::sqrt(2)), 1e-5);
    EXPECT_GT(values.at("flip_reflective").value(), 0.4);
    EXPECT_LT(values.at("ssim_reflective").value(), 0.7);
}

// Columns 0..4 do not reflect; the rest does, and from column 12 on it is rougher. Wrong is what lies about that border. Column 20 is background.
TEST(CompareImages, PicturesOverAllThatReflectsAndAtTheBorderOfMaterials)
{
    const glm::ivec2 size_px{24, 10};
    const Image      reference = uniform(size_px, glm::vec3(0));
    Image            tested    = reference;
    SceneTruth       truth;
    truth.size_px = size_px;
    GBufferImage gbuffer;
    gbuffer.view.size_px = size_px;
    for (int i = 0; i < size_px.x * size_px.y; ++i) {
        const int  x          = i % size_px.x;
        const bool reflecting = x >= 5;
        const bool background = x == 0 || x == 20;
        truth.cls.push_back(!reflecting || background ? TruthClass::not_traced
                            : x < 15                  ? TruthClass::visible
                                                      : TruthClass::sky);
        gbuffer.depth.push_back(background ? 0.0F : 0.5F);
        gbuffer.metallic.push_back(reflecting && !background ? 1.0F : 0.0F);
        gbuffer.roughness.push_back(x < 12 ? 0.3F : x < 17 ? 0.5F : 0.55F);
        if (x == 11 || x < 5)
            for (size_t c = 0; c < 3; ++c) tested.values[3 * static_cast<size_t>(i) + c] = 1;
    }
    const MeasureValues values = compare_pictures(tested, Reference(reference), truth, gbuffer);
    EXPECT_NEAR(values.at("picture_rmse").value(), std::sqrt(1.0 / 18), 1e-6);
    // Within 2 px of a change: columns 5, 6 beside what does not reflect, and 10 to 13.
    EXPECT_NEAR(values.at("picture_border_rmse").value(), std::sqrt(1.0 / 6), 1e-6);
    EXPECT_NEAR(values.at("picture_visible_rmse").value(), std::sqrt(0.1), 1e-6);
    EXPECT_NEAR(values.at("picture_visible_border_rmse").value(), std::sqrt(1.0 / 6), 1e-6);
    EXPECT_NEAR(values.at("picture_psnr_db").value(), 10 * std::log10(18), 1e-4);
    EXPECT_GT(values.at("picture_flip").value(), 0);
    EXPECT_LT(values.at("picture_ssim").value(), 1);
    gbuffer.metallic.assign(gbuffer.metallic.size(), 1);
    gbuffer.roughness.assign(gbuffer.roughness.size(), 0.3F);
    EXPECT_FALSE(compare_pictures(tested, Reference(reference), truth, gbuffer).at("picture_border_rmse"));
}

// A picture that is off by 0.1 everywhere, judged by the mean of two halves with normal errors of 0.05: the error is found without the
// noise, and the interval holds it. The display values are 0.5, where no half is clipped.
TEST(ComparePictures, TheNoiseOfTheReferenceIsTakenOff)
{
    const glm::ivec2                 size_px{64, 64};
    std::mt19937                     random(1);
    std::normal_distribution<double> error(0, 0.05);
    Image                            even = uniform(size_px, glm::vec3(0)), odd = even, mean = even;
    for (size_t v = 0; v < even.values.size(); ++v) {
        const double a = 0.5 + error(random), b = 0.5 + error(random);
        even.values[v] = srgb_to_linear(float(a));
        odd.values[v]  = srgb_to_linear(float(b));
        mean.values[v] = srgb_to_linear(float((a + b) / 2));
    }
    const SceneTruth truth = half_visible(size_px);
    GBufferImage     plain;
    plain.view.size_px = size_px;
    plain.depth.assign(pixel_count(size_px), 0);
    const Image         tested = uniform(size_px, glm::vec3(srgb_to_linear(0.6F)));
    const MeasureValues values = compare_pictures(tested, Reference(mean, std::array{even, odd}), truth, plain);
    const double        low = values.at("picture_rmse_low").value(), high = values.at("picture_rmse_high").value();
    EXPECT_NEAR(values.at("picture_noise_rmse").value(), 0.05 / std::sqrt(2.0), 5e-4);
    EXPECT_NEAR(values.at("picture_rmse").value(), 0.1, 1e-3);
    EXPECT_LT(low, 0.1);
    EXPECT_GT(high, 0.1);
    EXPECT_LT(high - low, 0.01);
    const MeasureValues with_noise = compare_pictures(tested, Reference(mean), truth, plain);
    EXPECT_NEAR(with_noise.at("picture_rmse").value(), std::sqrt(0.01 + 0.05 * 0.05 / 2), 1e-3);
    EXPECT_EQ(with_noise.at("picture_noise_rmse").value(), 0);
}

// SSIM sees luma alone, which is 0.5 in both.
TEST(ImageMeasures, SsimIsOfRec709Luma)
{
    const float     blue = (0.5F - 0.2126F * 0.9F - 0.7152F * 0.4F) / 0.0722F;
    const glm::vec3 colour{srgb_to_linear(0.9F), srgb_to_linear(0.4F), srgb_to_linear(blue)};
    const auto      values =
        compare_images(uniform({16, 16}, colour), Reference(uniform({16, 16}, glm::vec3(srgb_to_linear(0.5F)))),
                       half_visible({16, 16}));
    EXPECT_NEAR(values.at("ssim_visible").value(), 1, 1e-5);
    EXPECT_GT(values.at("rmse_visible").value(), 0.2);
}

TEST(ImageMeasures, OfDisplayValues)
{
    // sRGB encodes linear 0.2140 as 0.5; values beyond 1 are clamped.
    const MeasureValues values = compare_images(
        uniform({12, 12}, glm::vec3(7)), Reference(uniform({12, 12}, glm::vec3(0.2140411F))), half_visible({12, 12}));
    EXPECT_NEAR(values.at("rmse_visible").value(), 0.5, 1e-5);
    EXPECT_NEAR(values.at("psnr_visible_db").value(), 20 * std::log10(2), 1e-4);
}

TEST(NotFinite, PixelsOfThePictureAndOfItsGBufferCountOnce)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    constexpr glm::ivec2 four{4, 1};
    Image                picture{four, {"R", "G", "B"}, std::vector<float>(12, 0.5F), {}};
    GBufferImage         gbuffer;
    gbuffer.depth.assign(4, 0.5F);
    gbuffer.highlight.assign(4, glm::vec3(0));
    gbuffer.gradient.assign(4, glm::vec2(nan)); // not known
    EXPECT_EQ(count_not_finite(picture, &gbuffer).at("not_finite"), 0);
    picture.values[3 * 1 + 2] = nan;
    gbuffer.highlight[1].g    = infinity;
    gbuffer.highlight[3].r    = nan;
    EXPECT_EQ(count_not_finite(picture, &gbuffer).at("not_finite"), 2);
    EXPECT_EQ(count_not_finite(picture, nullptr).at("not_finite"), 1);
}

} // namespace
} // namespace ssrlab
