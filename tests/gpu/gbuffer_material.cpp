// Materials and light in the G-buffer against closed forms.
#include "core/pixel_index.h"
#include "frame/world_light.h"
#include "gpu/device.h"
#include "scene/model.h"
#include "scene/shapes.h"
#include "truth/scene_truth.h"

namespace ssrlab::test {
namespace {

constexpr double half_ulp = 1.0 / 1024; // colours are kept in half floats

/// A horizontal plane y = 0, seen from 4 m above.
Model plane(const Material& material)
{
    Model model;
    model.materials.push_back(material);
    Mesh mesh     = make_quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    mesh.name     = "plane";
    mesh.material = 0;
    model.meshes.push_back(std::move(mesh));
    model.ambient    = glm::vec3(0.1F, 0.2F, 0.3F);
    model.background = glm::vec3(0);
    return model;
}

Camera from_above()
{
    Camera camera;
    camera.position_ws = {0, 4, 0};
    camera.target_ws   = {0, 0, 0};
    camera.up_ws       = {0, 0, -1};
    camera.fov_y_deg   = 60;
    return camera;
}

ModelLight sun(glm::vec3 direction_ws, glm::vec3 irradiance, bool casts_shadow)
{
    ModelLight light;
    light.light.type         = LightType::directional;
    light.light.direction_ws = glm::normalize(direction_ws);
    light.light.intensity    = irradiance;
    light.light.casts_shadow = casts_shadow;
    return light;
}

void expect_colour(glm::vec3 found, glm::dvec3 expected, const std::string& where)
{
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(found[c]), expected[c], half_ulp * expected[c] + 1e-5)
            << where << ", channel " << c;
}

const Material matt = make_material("matt", {0.8F, 0.5F, 0.25F}, 0.25F, 0.625F);

TEST(GBufferMaterial, ValuesArriveAtEveryPixel)
{
    const Picture picture = make_picture(model_to_scene(plane(matt), "plane"), from_above(), {31, 19});
    for (size_t i = 0; i < picture.image.depth.size(); ++i) {
        const std::string where = fmt::format("pixel {}", i);
        expect_colour(picture.image.base_colour[i], {0.8, 0.5, 0.25}, where);
        EXPECT_NEAR(picture.image.metallic[i], 0.25, 1e-3) << where;
        EXPECT_NEAR(picture.image.roughness[i], 0.625, 1e-6) << where;
        EXPECT_EQ(picture.image.object_id[i], 1U) << where;
    }
}

// Lambert: base colour x ((1 - metallic) / pi x irradiance x cosine + ambient) + emissive.
TEST(GBufferMaterial, LambertPlaneUnderTheSun)
{
    for (const bool shadows : {false, true})
        for (const double angle_deg : {0.0, 30.0, 75.0, 100.0}) {
            const double angle    = angle_deg * std::numbers::pi / 180;
            Material     material = matt;
            material.emissive     = {0, 0.125F, 2};
            Model model           = plane(material);
            model.lights.push_back(sun({static_cast<float>(std::sin(angle)), static_cast<float>(-std::cos(angle)), 0},
                                       {3, 2, 1}, shadows));
            const Picture    picture = make_picture(model_to_scene(std::move(model), "plane"), from_above(), {17, 11});
            const glm::dvec3 light   = glm::dvec3(3, 2, 1) * std::max(0.0, std::cos(angle)) * (0.75 / std::numbers::pi);
            const glm::dvec3 expected =
                glm::dvec3(0.8, 0.5, 0.25) * (light + glm::dvec3(0.1, 0.2, 0.3)) + glm::dvec3(0, 0.125, 2);
            for (size_t i = 0; i < picture.image.radiance.size(); ++i)
                expect_colour(picture.image.radiance[i], expected,
                              fmt::format("pixel {}, sun at {} degrees, shadows {}", i, angle_deg, shadows));
        }
}

// A plate of 2 m x 2 m floats 1 m above the plane; the sun comes at 45 degrees along +x, so its shadow lies 1 m further: x in [0, 2].
TEST(GBufferMaterial, ShadowLiesWhereTheSunPutsIt)
{
    for (const bool shadows : {true, false}) {
        Model model    = plane(matt);
        Mesh  plate    = make_box({-1, 1, -1}, {1, 1.02, 1});
        plate.name     = "plate";
        plate.material = 0;
        model.meshes.push_back(std::move(plate));
        model.lights.push_back(sun({1, -1, 0}, glm::vec3(4), shadows));
        const Picture    picture = make_picture(model_to_scene(std::move(model), "plate"), from_above(), {64, 64});
        const glm::dvec3 base(0.8, 0.5, 0.25), ambient(0.1, 0.2, 0.3);
        const glm::dvec3 dark = base * ambient, lit = base * (ambient + 4 * std::sqrt(0.5) * 0.75 / std::numbers::pi);
        size_t           dark_pixels = 0;
        for (const auto [i, x, y] : pixels_of({64, 64})) {
            if (picture.image.object_id[i] != 1) continue;
            const glm::dvec3 p =
                px_to_vs(picture.view, glm::dvec2(x, y) + 0.5,
                         static_cast<double>(picture.image.depth[i]));             // p.x, p.y: the plane's x and -z
            const double outside = std::max(std::abs(p.x - 1), std::abs(p.y)) - 1; // metres outside the shadow
            if (std::abs(outside) < 0.05) continue;
            const bool in_shadow = shadows && outside < 0;
            dark_pixels += in_shadow;
            expect_colour(picture.image.radiance[i], in_shadow ? dark : lit, fmt::format("pixel ({}, {})", x, y));
        }
        EXPECT_EQ(dark_pixels > 100, shadows);
    }
}

// Inverse square and the two cosines: I x cos / d^2, lamp 2 m above the plane's origin.
TEST(GBufferMaterial, PointLightFallsOffWithTheSquare)
{
    if (!draws_exactly()) GTEST_SKIP() << "this driver draws less exactly";
    Model      model = plane(matt);
    ModelLight lamp;
    lamp.light.type         = LightType::point;
    lamp.light.intensity    = glm::vec3(10);
    lamp.light.casts_shadow = false;
    lamp.position_ws        = {0, 2, 0};
    model.lights.push_back(lamp);
    const Picture picture = make_picture(model_to_scene(std::move(model), "lamp"), from_above(), {40, 30});
    for (const auto [i, x, y] : pixels_of({40, 30})) {
        const glm::dvec3 p =
            px_to_vs(picture.view, glm::dvec2(x, y) + 0.5, static_cast<double>(picture.image.depth[i]));
        const double d2 = p.x * p.x + p.y * p.y + 4, light = 10 * 2 / std::sqrt(d2) / d2 * 0.75 / std::numbers::pi;
        expect_colour(picture.image.radiance[i], glm::dvec3(0.8, 0.5, 0.25) * (glm::dvec3(0.1, 0.2, 0.3) + light),
                      fmt::format("pixel ({}, {})", x, y));
    }
}

// Every third light comes from below, and does not reach the plane.
TEST(GBufferMaterial, EveryLightOfManyCounts)
{
    for (const int lights : {0, 1, 31, 32, 33, 70}) {
        Model  model      = plane(matt);
        double irradiance = 0;
        for (int i = 0; i < lights; ++i) {
            const bool  below = i % 3 == 2;
            const float own   = static_cast<float>(i + 1) / 256;
            model.lights.push_back(sun({0, below ? 1 : -1, 0}, glm::vec3(own), false));
            if (!below) irradiance += static_cast<double>(own);
        }
        Scene scene = model_to_scene(std::move(model), "lights");
        scene.lights.resize(static_cast<size_t>(lights)); // a model without lights gets one
        const Picture    picture = make_picture(scene, from_above(), {16, 12});
        const glm::dvec3 light   = glm::dvec3(0.1, 0.2, 0.3) + irradiance * 0.75 / std::numbers::pi;
        for (const glm::vec3& radiance : picture.image.radiance)
            expect_colour(radiance, glm::dvec3(0.8, 0.5, 0.25) * light, fmt::format("{} lights", lights));
    }
}

// Light of vertices grows along x and z. In the frame, at what rays of the world meet, and in the truth: base colour x
// (bounced + ambient). Of both, 1 - metallic is the diffuse part.
TEST(GBufferMaterial, LightOfVerticesIsTheSameInFrameWorldAndTruth)
{
    Scene scene = model_to_scene(plane(matt), "plane");
    scene.lights.clear();
    for (Vertex& vertex : scene.vertices) vertex.bounced = {vertex.position_ws.x + 5, vertex.position_ws.z + 5, 1};
    const Picture         picture = make_picture(scene, from_above(), {40, 30});
    const SceneBvh        bvh(scene);
    std::vector<WorldRay> rays;
    for (const auto [i, x, y] : pixels_of({40, 30})) {
        const glm::dvec3 p =
            px_to_vs(picture.view, glm::dvec2(x, y) + 0.5, static_cast<double>(picture.image.depth[i]));
        rays.push_back({{p.x, 1, -p.y}, 0, {0, -1, 0}, 2, 0});
    }
    const WorldPtr   world = upload_world(device(), scene);
    const WorldLight light = shade_world(device(), *world, *upload_scene(device(), scene), upload_dfg_table(device()),
                                         {}, false, rays, trace_world(device(), *world, rays).hits);
    for (const auto [i, x, y] : pixels_of({40, 30})) {
        const glm::dvec3 from(rays[i].origin_ws), bounced(from.x + 5, from.z + 5, 1);
        const glm::dvec3 base(0.8, 0.5, 0.25), ambient(0.1, 0.2, 0.3), expected = base * (bounced + ambient);
        const SceneRay   ray{from, {0, -1, 0}, 0, 2};
        SceneHit         hit;
        bvh.intersect({&ray, 1}, {&hit, 1});
        const std::string where = fmt::format("pixel ({}, {})", x, y);
        if (draws_exactly()) {
            expect_colour(picture.image.radiance[i], expected, where);
            const glm::dvec3 without = glm::dvec3(picture.image.radiance[i]) - 0.25 * base * ambient;
            EXPECT_NEAR((without.r + without.g + without.b) * static_cast<double>(picture.image.diffuse_share[i]),
                        0.75 * glm::dot(base, bounced + ambient), 0.01)
                << where;
        }
        expect_colour(light.light[i], expected, where + ", world");
        expect_colour(shade_point(bvh, scene, hit, {from.x, 0, from.z}, ray.direction_ws), expected, where + ", truth");
    }
}

// What the planned frame skips is measured on these.
TEST(GBufferMaterial, ATenthOfTheSmallMirrorSceneReflectsAndNothingOfTheMatteOne)
{
    for (const auto& [scene, from, to] :
         {std::tuple("builtin:small_mirror", 0.09, 0.12), {"builtin:matte", 0.0, 0.0}}) {
        const Picture picture = make_picture(scene, "default", {320, 180});
        double        share   = 0;
        for (const float metallic : picture.image.metallic) share += metallic > 0;
        share /= 320 * 180;
        EXPECT_GE(share, from) << scene;
        EXPECT_LE(share, to) << scene;
    }
}

} // namespace
} // namespace ssrlab::test
