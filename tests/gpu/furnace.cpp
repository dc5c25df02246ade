// Furnaces: surroundings of radiance 1 from everywhere, and surfaces that glow in them, by every reflectance model.
//
// The rendering equation (J. Kajiya 1986): outgoing = emitted + integral of f(in, out) cos * incoming. With incoming radiance 1 the integral is the
// share of light that a surface scatters, at most 1; 1 where it absorbs nothing. Emission is a term of its own: no factor of the surface touches it.
#include "core/pixel_index.h"
#include "gpu/passes.h"
#include "scene/model.h"
#include "scene/shapes.h"

namespace ssrlab::test {
namespace {

struct Furnace {
    float reflectance = 0; // the model: Reflectance
    float metallic = 0, roughness = 0;
};

class Furnaces : public testing::TestWithParam<Furnace> {};

/// A wall in the furnace: what it scatters diffusely is in its own light, what it reflects is 1. Colours of the picture's middle pixel.
/// baked: its own light also has what stands in for the reflection of a metal.
glm::vec3 shown(const Furnace& furnace, float base, glm::vec3 emission, bool baked = false)
{
    GBufferImage image = metal_wall({16, 16});
    std::ranges::fill(image.metallic, furnace.metallic);
    std::ranges::fill(image.roughness, furnace.roughness);
    std::ranges::fill(image.base_colour, glm::vec3(base));
    std::ranges::fill(image.radiance, glm::vec3(base * (baked ? 1 : 1 - furnace.metallic)) + emission);
    if (baked) image.diffuse_share.assign(image.depth.size(), 1 - furnace.metallic);
    image.emission.assign(image.depth.size(), emission);
    const Picture picture = make_picture(image);
    const auto    frame   = frame_with(picture, {{"reflectance", furnace.reflectance}, {"metallic_exponent", 1}});
    set_reflection(picture, Reflection(image.depth.size(), glm::vec4(1)));
    run_pass(*frame, composite_pass());
    return glm::vec3(read_colours(picture.buffers->shaded)[pixel_index({8, 8}, {16, 16})]);
}

TEST_P(Furnaces, ScatterAtMostWhatArrivesAndEmitAllThatGlows)
{
    constexpr float half_ulp = 0x1p-10F;
    for (const float base : {0.0F, 0.5F, 1.0F}) {
        const glm::vec3 dark = shown(GetParam(), base, glm::vec3(0));
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(dark[c], 0);
            EXPECT_LE(dark[c], 1 + half_ulp) << "base colour " << base;
        }
        if (base == 1 && GetParam().metallic == 0) {
            EXPECT_NEAR(dark.g, 1, half_ulp) << "white: nothing is absorbed";
        }
        const glm::vec3 emission(4, 0.5F, 0.25F), glowing = shown(GetParam(), base, emission);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(glowing[c], dark[c] + emission[c], (1 + 2 * emission[c]) * half_ulp) << "base colour " << base;
    }
}

// The model `metallic` blends with all of the own light, by metallic^1.
TEST_P(Furnaces, ShowBakedLightOnMetalOnlyWhereTheReflectionIsNotKnown)
{
    const float metallic = GetParam().metallic;
    const float kept     = GetParam().reflectance == float(Reflectance::metallic) ? metallic * (1 - metallic) : 0;
    for (const float base : {0.0F, 0.5F, 1.0F})
        for (const glm::vec3& emission : {glm::vec3(0), glm::vec3(4, 0.5F, 0.25F)}) {
            const glm::vec3 plain = shown(GetParam(), base, emission), baked = shown(GetParam(), base, emission, true);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(baked[c], plain[c] + kept * base, (1 + 2 * emission[c]) * 0x1p-10F) << base;
        }
}

INSTANTIATE_TEST_SUITE_P(
    Models, Furnaces,
    testing::Values(Furnace{float(Reflectance::metallic), 0, 0}, Furnace{float(Reflectance::metallic), 0.5F, 0.3F},
                    Furnace{float(Reflectance::metallic), 1, 0.3F}, Furnace{float(Reflectance::ggx), 0, 0},
                    Furnace{float(Reflectance::ggx), 0, 0.7F}, Furnace{float(Reflectance::ggx), 0.5F, 0.3F},
                    Furnace{float(Reflectance::ggx), 1, 0}, Furnace{float(Reflectance::ggx), 1, 0.7F}));

Scene glowing_plane(float metallic, double half_m = 5)
{
    Material material = make_material("neon", {1, 1, 1}, metallic, 0.1F);
    material.emissive = {4, 0.5F, 70000};
    Model model;
    model.materials.push_back(material);
    model.meshes.push_back(make_quad({-half_m, 0, half_m}, {2 * half_m, 0, 0}, {0, 0, -2 * half_m}));
    model.ambient = glm::vec3(0);
    ModelLight lamp;
    lamp.light.type         = LightType::point;
    lamp.light.intensity    = glm::vec3(30);
    lamp.light.casts_shadow = false;
    lamp.position_ws        = {0, 2, 3};
    model.lights.push_back(lamp);
    return model_to_scene(std::move(model), "plane");
}

Camera camera_at(glm::dvec3 position_ws)
{
    Camera camera;
    camera.position_ws = position_ws;
    camera.target_ws   = {0, 0, 0};
    return camera;
}

TEST(GlowingMetal, IsInTheGBufferWithWhatItEmits)
{
    for (const float metallic : {0.0F, 1.0F}) {
        const Picture picture = make_picture(glowing_plane(metallic), camera_at({0, 4, 1}), {16, 16});
        const size_t  i       = pixel_index({8, 8}, {16, 16});
        EXPECT_EQ(emission_at(picture.image, i), glm::vec3(4, 0.5F, 65504)) << "the most that pictures hold";
        EXPECT_GE(picture.image.radiance[i].r, 4 - 0x1p-8F);
        EXPECT_EQ(picture.image.radiance[i].b, 65504);
    }
}

// The half vector is then the direction of both, and the dot product of unit vectors may round above 1.
TEST(LampAtTheCamera, LightsEveryPixelFinitely)
{
    for (const glm::dvec3& position_ws : {glm::dvec3(0, 2, 3), glm::dvec3(0, 2, 3.0001), glm::dvec3(0, 5547, 8321)}) {
        Scene scene                 = glowing_plane(0, 2 * glm::length(position_ws));
        scene.lights[0].position_ws = glm::vec3(position_ws);
        scene.lights[0].intensity   = glm::vec3(static_cast<float>(30 * glm::dot(position_ws, position_ws)));
        const Picture picture       = make_picture(scene, camera_at(position_ws), {160, 90});
        size_t        lit           = 0;
        for (size_t i = 0; i < picture.image.depth.size(); ++i) {
            for (int c = 0; c < 3; ++c)
                ASSERT_TRUE(std::isfinite(picture.image.highlight[i][c]) && std::isfinite(picture.image.radiance[i][c]))
                    << i;
            lit += picture.image.highlight[i].r > 0;
        }
        EXPECT_GT(lit, 0U);
    }
}

} // namespace
} // namespace ssrlab::test
