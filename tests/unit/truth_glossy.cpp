// The glossy truth where its answer is known: white surroundings, mirrors, symmetry; and whether its error bars are honest.
#include "core/error.h"
#include "core/pixel_index.h"
#include "scene/environment.h"
#include "truth/glossy_truth.h"
#include "truth_scenes.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr double pi = std::numbers::pi;

/// Orthographic: every pixel sees the same plane from the same direction, `angle` off its normal.
GBufferImage tilted_plane(double angle, float roughness, glm::ivec2 size_px = {64, 64})
{
    View view            = bench_view(size_px);
    view.projection      = Projection::orthographic;
    GBufferImage gbuffer = empty_gbuffer(view);
    for (const auto [i, x, y] : pixels_of(size_px))
        set_pixel(gbuffer, x, y, 5, {0, std::sin(angle), std::cos(angle)}, 1);
    std::ranges::fill(gbuffer.roughness, roughness);
    std::ranges::fill(gbuffer.base_colour, glm::vec3(1)); // Fresnel's factor is 1
    return gbuffer;
}

/// The integral of D G2 / (4 n.v) over the directions l of the hemisphere: GGX as Walter et al. 2007 write it.
double albedo_by_quadrature(double angle, double alpha)
{
    const glm::dvec3 v(std::sin(angle), 0, std::cos(angle));
    const auto    tan2_term = [&](double cosine) { return std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)); };
    constexpr int rows = 2000, columns = 1000;
    double        sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double     theta = 0.5 * pi * (i + 0.5) / rows, phi = pi * (j + 0.5) / columns;
            const glm::dvec3 l(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            const double     n_h = glm::normalize(v + l).z, d = n_h * n_h * (alpha * alpha - 1) + 1;
            const double     ggx = alpha * alpha / (pi * d * d);
            // G2 = 1 / (1 + Lambda(v) + Lambda(l)), Lambda = (root - 1) / 2.
            const double g2 = 2 / (tan2_term(v.z) + tan2_term(l.z));
            sum += ggx * g2 / (4 * v.z) * std::sin(theta);
        }
    return 2 * sum * (0.5 * pi / rows) * (pi / columns);
}

double mean_of(const std::vector<glm::vec3>& values)
{
    double sum = 0;
    for (const glm::vec3& value : values) sum += double(value.g);
    return sum / double(values.size());
}

// 4096 pixels of 64 rays: the mean's own error is about 0.0004.
TEST(GlossyTruth, WhiteSurroundingsGiveTheAlbedo)
{
    Scene scene;
    scene.background = glm::vec3(1);
    for (const float roughness : {0.1F, 0.5F, 0.8F, 1.0F})
        for (const double angle : {0.0, 0.6, 1.2}) {
            const GBufferImage gbuffer = tilted_plane(angle, roughness);
            const GlossyTruth  truth   = glossy_truth(SceneBvh(scene), scene, gbuffer, {}, {.rays = 64});
            const double       alpha   = double(roughness) * double(roughness);
            EXPECT_NEAR(mean_of(truth.albedo), albedo_by_quadrature(angle, alpha), 2e-3) << roughness << ' ' << angle;
            for (size_t i = 0; i < truth.albedo.size(); ++i) ASSERT_NEAR(truth.radiance[i].g, truth.albedo[i].g, 1e-6F);
        }
}

// The rendering equation inside a ball that emits E everywhere and scatters the share a of what arrives, three bounces deep: E (1 + a + a^2 + a^3).
// A white metal's a is the albedo of its lobe, which depends on the direction.
class GlowingBall : public testing::TestWithParam<float> {}; // roughness; 1: it does not reflect

TEST_P(GlowingBall, EverythingInsideGlows)
{
    Scene scene;
    scene.ambient                   = glm::vec3(0);
    const uint32_t ball             = add_material(scene, {1, 1, 1}, GetParam() < 1 ? 1 : 0);
    scene.materials[ball].roughness = GetParam();
    scene.materials[ball].emissive  = {0.25F, 0.5F, 2};
    scene.background                = glm::vec3(1000); // outside
    add_sphere(scene, ball, {0, 0, -5}, 20, 32);
    const GBufferImage gbuffer = tilted_plane(0.3, 0.6F, {16, 16});
    const GlossyTruth  truth   = glossy_truth(SceneBvh(scene), scene, gbuffer, {}, {.rays = 64});
    const double       roughness =
        std::max(double(GetParam()), 0.6); // a path's surfaces are at least as rough as where it began
    double least = 1, most = 0;            // share that is scattered
    for (const double angle : {0.0, 0.4, 0.8, 1.2, 1.5}) {
        const double share = GetParam() == 1 ? 0 : albedo_by_quadrature(angle, roughness * roughness);
        least              = std::min(least, share);
        most               = std::max(most, share);
    }
    const auto with_bounces = [](double a) { return 1 + a + a * a + a * a * a; };
    size_t     leaks        = 0;
    double     sum = 0, values = 0;
    for (size_t i = 0; i < truth.albedo.size(); ++i) {
        ASSERT_GT(truth.albedo[i].g, 0.5F);
        for (int c = 0; c < 3; ++c) {
            const double times = double(truth.radiance[i][c] / truth.albedo[i][c] / scene.materials[ball].emissive[c]);
            ASSERT_GT(times, 0.999) << "emission is whole";
            const bool leaked = times > 4.01; // a path through the edge between two triangles sees the background
            leaks += leaked;
            sum += leaked ? 0 : times;
            values += !leaked;
        }
    }
    EXPECT_LE(leaks, 6U) << "of 3 x 256 values";
    EXPECT_LT(sum / values, 1.001 * with_bounces(most));
    // A twentieth for paths whose interpolated normals lead them into the ball's flat triangles: they end there.
    EXPECT_GT(sum / values, 0.95 * with_bounces(least));
}

// Baked light stands in for what the metal of the third bounce reflects, and for nothing that is traced: a^3 times it.
TEST(BakedBall, StandsInAfterTheLastBounceAlone)
{
    const float roughness = 0.7F, baked = 8;
    const auto  mean = [&](float bounced) {
        Scene scene;
        scene.ambient                   = glm::vec3(0);
        const uint32_t ball             = add_material(scene, {1, 1, 1}, 1);
        scene.materials[ball].roughness = roughness;
        add_sphere(scene, ball, {0, 0, -5}, 20, 32);
        for (Vertex& vertex : scene.vertices) vertex.bounced = glm::vec3(bounced);
        const GlossyTruth truth =
            glossy_truth(SceneBvh(scene), scene, tilted_plane(0.3, 0.6F, {16, 16}), {}, {.rays = 64});
        return mean_of(truth.radiance) / mean_of(truth.albedo);
    };
    double least = 1, most = 0;
    for (const double angle : {0.0, 0.4, 0.8, 1.2, 1.5}) {
        const double share = albedo_by_quadrature(angle, double(roughness) * double(roughness));
        least              = std::min(least, share);
        most               = std::max(most, share);
    }
    EXPECT_EQ(mean(0), 0);
    EXPECT_GT(mean(baked), double(baked) * std::pow(least, 3));
    // A twentieth for paths whose interpolated normals lead them into the ball's flat triangles: they end there.
    EXPECT_LT(mean(baked), 1.05 * double(baked) * std::pow(most, 3));
}

INSTANTIATE_TEST_SUITE_P(Roughness, GlowingBall, testing::Values(0.0F, 0.3F, 0.7F, 1.0F));

double mean_of(const Image& picture)
{
    double sum = 0;
    for (const float value : picture.values) sum += double(value);
    return sum / double(picture.values.size());
}

/// A plane of that material in surroundings of radiance 1, which its own light knows as the ambient one, or as baked.
Image plane_in_white(GBufferImage gbuffer, float base, float metallic, float dielectric_f0, bool baked = false)
{
    Scene scene;
    scene.background = glm::vec3(1);
    scene.ambient    = glm::vec3(baked ? 0 : 1);
    if (baked) gbuffer.diffuse_share.assign(gbuffer.depth.size(), 1 - metallic);
    std::ranges::fill(gbuffer.base_colour, glm::vec3(base));
    std::ranges::fill(gbuffer.metallic, metallic);
    std::ranges::fill(gbuffer.dielectric_f0, dielectric_f0);
    std::ranges::fill(gbuffer.radiance, glm::vec3(base));
    const TraceSettings settings{.dielectric_max_roughness = 1};
    return true_picture(glossy_truth(SceneBvh(scene), scene, gbuffer, settings, {}), gbuffer, scene.ambient);
}

// The white furnace: a white dielectric gives back all that arrives, a white metal its directional albedo, since single scattering
// loses the rest.
TEST(TruePicture, SplitsEnergyInAWhiteFurnace)
{
    for (const float roughness : {0.0F, 0.3F, 0.7F})
        for (const double angle : {0.0, 1.2}) {
            const GBufferImage gbuffer = tilted_plane(angle, roughness, {32, 32});
            EXPECT_NEAR(mean_of(plane_in_white(gbuffer, 1, 0, 0.04F)), 1, 1e-5) << roughness << ' ' << angle;
            const double albedo =
                roughness > 0 ? albedo_by_quadrature(angle, double(roughness) * double(roughness)) : 1;
            EXPECT_NEAR(mean_of(plane_in_white(gbuffer, 1, 1, 0.04F)), albedo, 4e-3) << roughness << ' ' << angle;
            for (const float metallic : {0.0F, 0.5F, 1.0F})
                EXPECT_NEAR(mean_of(plane_in_white(gbuffer, 0.5F, metallic, 0.04F, true)),
                            mean_of(plane_in_white(gbuffer, 0.5F, metallic, 0.04F)), 1e-6)
                    << roughness << ' ' << angle << ' ' << metallic;
        }
}

// Whatever the surface scatters, what it emits comes on top of it, whole: the rendering equation's first term.
TEST(TruePicture, AddsEmissionWholeToAnySurface)
{
    Scene scene;
    scene.background = scene.ambient = glm::vec3(1);
    const glm::vec3 emission(4, 0.5F, 0.25F);
    for (const float metallic : {0.0F, 0.5F, 1.0F})
        for (const float roughness : {0.0F, 0.3F, 0.7F})
            for (const float base : {0.0F, 0.5F, 1.0F}) {
                GBufferImage gbuffer = tilted_plane(0.5, roughness, {8, 8});
                const Image  dark    = plane_in_white(gbuffer, base, metallic, 0.04F);
                std::ranges::fill(gbuffer.base_colour, glm::vec3(base));
                std::ranges::fill(gbuffer.metallic, metallic);
                std::ranges::fill(gbuffer.dielectric_f0, 0.04F);
                std::ranges::fill(gbuffer.radiance, glm::vec3(base) + emission);
                gbuffer.emission.assign(gbuffer.depth.size(), emission);
                const TraceSettings settings{.dielectric_max_roughness = 1};
                const Image         glowing =
                    true_picture(glossy_truth(SceneBvh(scene), scene, gbuffer, settings, {}), gbuffer, scene.ambient);
                for (size_t i = 0; i < dark.values.size(); ++i)
                    ASSERT_NEAR(glowing.values[i], dark.values[i] + emission[int(i % 3)], 1e-5F)
                        << metallic << ' ' << roughness << ' ' << base;
            }
}

// J. Somerville Roberts' formula, whose C_frag is all of the own light but what is emitted: colour and angle of the mirror do not matter,
// and what the ray meets is shaded as ever.
TEST(TruePicture, WithAMetallicExponentBlendsWithWhatTheRayMeets)
{
    const glm::vec3 own(0.25F, 0.5F, 0.125F), emission(0.125F, 0.25F, 0), highlight(0.5F, 0, 1), lit(0.75F, 0.5F, 2);
    for (const float roughness : {0.0F, 0.6F})
        for (const float metallic : {1.0F, 0.5F})
            for (const float exponent : {0.0F, 1.0F, 2.0F}) {
                Scene scene;
                scene.ambient = glm::vec3(1);
                if (roughness > 0)
                    scene.background = lit; // all around, which a lobe shows as it is
                else
                    add_quad(scene, add_material(scene, lit, 0), {-500, 100, -500}, {1000, 0, 0}, {0, 0, 1000});
                GBufferImage gbuffer = tilted_plane(1, roughness, {8, 8});
                std::ranges::fill(gbuffer.base_colour, glm::vec3(1, 0.5F, 0));
                std::ranges::fill(gbuffer.metallic, metallic);
                std::ranges::fill(gbuffer.radiance, own);
                std::ranges::fill(gbuffer.highlight, highlight);
                gbuffer.emission.assign(gbuffer.depth.size(), emission);
                const GlossyTruth truth =
                    glossy_truth(SceneBvh(scene), scene, gbuffer, {}, {.rays = 64, .metallic_exponent = exponent});
                const float     share    = exponent == 0 ? 1 : exponent == 1 ? metallic : metallic * metallic;
                const glm::vec3 expected = emission + share * lit + (1 - share) * (own - emission + highlight);
                for (const float noises : {-1.0F, 0.0F, 1.0F}) { // light that is equal everywhere has no noise
                    const Image picture = true_picture(truth, gbuffer, scene.ambient, noises);
                    for (size_t i = 0; i < picture.values.size(); ++i)
                        ASSERT_NEAR(picture.values[i], expected[int(i % 3)], 1e-5F)
                            << roughness << ' ' << metallic << ' ' << exponent;
                }
            }
}

TEST(TruePicture, ABlackSmoothDielectricReflectsItsF0AtNormalIncidence)
{
    for (const float f0 : {0.02F, 0.04F, 0.17F}) // water, glass, diamond
        EXPECT_NEAR(mean_of(plane_in_white(tilted_plane(0, 0, {8, 8}), 0, 0, f0)), double(f0), 1e-6);
    // At 60 degrees, by Schlick: 0.04 + 0.96 (1 - 0.5)^5.
    EXPECT_NEAR(mean_of(plane_in_white(tilted_plane(std::numbers::pi / 3, 0, {8, 8}), 0, 0, 0.04F)), 0.07, 1e-6);
}

/// Mirror floor, wall with posts before it, and light: some of it on screen.
struct Room {
    Scene        scene;
    GBufferImage gbuffer = floor_and_wall(bench_view({64, 64}), 10);

    explicit Room(float roughness)
    {
        test::add_floor(scene, add_material(scene, {1, 1, 1}, 1));
        add_wall(scene, add_material(scene, {0.8F, 0.5F, 0.2F}, 0), 10);
        const uint32_t post            = add_material(scene, {0, 0, 0}, 0);
        scene.materials[post].emissive = {4, 1, 0};
        for (const double x_m : {-3.0, 3.0}) add_quad(scene, post, {x_m - 0.5, -1, -6}, {1, 0, 0}, {0, 3, 0});
        scene.lights.push_back({});
        std::ranges::fill(gbuffer.roughness, roughness);
        std::ranges::fill(gbuffer.base_colour, glm::vec3(1));
        for (size_t i = 0; i < gbuffer.radiance.size(); ++i)
            gbuffer.radiance[i] = glm::vec3(0.2F + 0.01F * float(pixel_at(i, gbuffer.view.size_px).y), 0.4F, 0.1F);
    }
    GlossyTruth truth(const GlossySettings& settings = {}, unsigned threads = 0) const
    {
        return glossy_truth(SceneBvh(scene), scene, gbuffer, {}, settings, threads);
    }
};

TEST(GlossyTruth, SmoothIsTheSceneTruthToTheLastBit)
{
    for (const float roughness : {0.0F, 0.0199F}) {
        Room room(roughness);
        room.scene.lights.clear(); // whose highlights the scene truth does not have
        const SceneTruth  mirror = scene_truth(SceneBvh(room.scene), room.scene, room.gbuffer, {});
        const GlossyTruth truth  = room.truth();
        EXPECT_EQ(truth.radiance, mirror.radiance);
        for (size_t i = 0; i < truth.rays.size(); ++i)
            ASSERT_EQ(truth.rays[i], mirror.cls[i] == TruthClass::not_traced ? 0U : 1U);
    }
}

// The next lobe is a twentieth of a degree wide: almost the mirror.
TEST(GlossyTruth, NearlySmoothIsNearlyTheMirror)
{
    Room room(mirror_roughness);
    room.scene.lights.clear();
    const SceneTruth  mirror = scene_truth(SceneBvh(room.scene), room.scene, room.gbuffer, {});
    const GlossyTruth truth  = room.truth();
    size_t            far = 0, traced = 0;
    for (size_t i = 0; i < truth.rays.size(); ++i) {
        if (truth.rays[i] == 0) continue;
        ++traced;
        EXPECT_EQ(truth.rays[i], uint32_t(GlossySettings{}.rays));
        far += glm::length(truth.radiance[i] - mirror.radiance[i]) > 0.05F;
    }
    EXPECT_GT(traced, 1000U);
    EXPECT_LT(far, traced / 20) << "only at the posts' and the wall's borders";
}

TEST(GlossyTruth, ASymmetricSceneHasASymmetricReflection)
{
    Room room(0.4F);
    // As bright as the wall: where a lobe sees an edge between bright and dark, filling it evenly gains less.
    room.scene.materials[2].emissive = {0.4F, 0.4F, 0.1F};
    const GlossyTruth truth          = room.truth({.rays = 64});
    size_t            outliers       = 0;
    double            differences = 0, noise = 0;
    for (int y = 36; y < 64; ++y)
        for (int x = 0; x < 32; ++x) {
            const size_t a = at(room.gbuffer, x, y), b = at(room.gbuffer, 63 - x, y);
            const double off = double(truth.radiance[a].r) - double(truth.radiance[b].r);
            outliers += std::abs(off) > 0.1;
            differences += off * off;
            noise += double(truth.noise[a].r * truth.noise[a].r + truth.noise[b].r * truth.noise[b].r);
        }
    // Mirrored pixels err independently, so the squares of their differences add up to their noise: 896 pairs, 10 %.
    EXPECT_NEAR(differences / noise, 1, 0.2);
    EXPECT_EQ(outliers, 0U);
}

// As --samples takes them.
TEST(GlossyTruth, PartsOfTheRaysFillTheLobeTogether)
{
    const Room             room(0.5F);
    const GlossyTruth      whole = room.truth({.rays = 64});
    std::vector<glm::vec3> mean(whole.radiance.size(), glm::vec3(0));
    for (int part = 0; part < 16; ++part) {
        const GlossyTruth truth = room.truth({.rays = 4, .first = 4 * part});
        for (size_t i = 0; i < mean.size(); ++i) mean[i] += truth.radiance[i] / 16.0F;
    }
    for (size_t i = 0; i < mean.size(); ++i)
        ASSERT_LT(glm::length(mean[i] - whole.radiance[i]), 1e-5F) << "the same rays";
}

// Those of independent rays would be halved.
TEST(GlossyTruth, FourTimesTheRaysMoreThanHalveTheError)
{
    const Room room(0.5F);
    double     few = 0, many = 0;
    for (const glm::vec3& noise : room.truth({.rays = 64}).noise) few += double(noise.r * noise.r);
    for (const glm::vec3& noise : room.truth({.rays = 256}).noise) many += double(noise.r * noise.r);
    EXPECT_GT(std::sqrt(few / many), 2.5);
}

// A pixel of a mirror has one ray. From the rough wall that it meets many go on, so the wall looks as smooth there as it does by itself.
TEST(GlossyTruth, ARoughSurfaceInAMirrorHasLittleNoise)
{
    Room room(0);
    room.scene.materials[1].metallic  = 1;
    room.scene.materials[1].roughness = 0.5F;
    struct Noise {
        double rms = 0, mean = 0;
    };
    const auto noise = [&](int rays) {
        const GlossyTruth a = room.truth({.rays = rays}), b = room.truth({.rays = rays, .seed = 1});
        double            squares = 0;
        for (size_t i = 0; i < a.rays.size(); ++i) {
            const double off = double(a.radiance[i].g) - double(b.radiance[i].g);
            squares += off * off;
        }
        return Noise{std::sqrt(squares / double(a.rays.size())), mean_of(a.radiance)};
    };
    const Noise few = noise(4), many = noise(64);
    ASSERT_GT(few.rms, 0);
    EXPECT_LT(many.rms, few.rms / 4) << "16 times the rays";
    EXPECT_NEAR(many.mean, few.mean, 0.01 * few.mean);
}

TEST(GlossyTruth, IsTheSameOnEveryNumberOfThreadsAndAnotherWithAnotherSeed)
{
    const Room        room(0.5F);
    const GlossyTruth one = room.truth({.rays = 64}, 1);
    EXPECT_EQ(one.radiance, room.truth({.rays = 64}, 5).radiance);
    EXPECT_NE(one.radiance, room.truth({.rays = 64, .seed = 1}).radiance);
}

TEST(GlossyTruth, RefusesWhatItCannotUse)
{
    Room room(0.5F);
    EXPECT_THROW(room.truth({.rays = 0}), Failure);
    EXPECT_THROW(room.truth({.rays = 3}), Failure);
    EXPECT_THROW(room.truth({.rays = 4, .first = 1}), Failure);
    room.gbuffer.roughness.pop_back();
    EXPECT_THROW(room.truth(), Failure);
}

} // namespace
} // namespace ssrlab
