// What the truths on the host read of materials, textures and lights, against values worked out by hand.
#include "truth/scene_surface.h"

#include "truth/scene_truth.h"
#include "truth_scenes.h"

namespace ssrlab {
namespace {

using namespace test;

/// Red is 16 times the column, green 64 times the row, blue 51 and alpha 102.
Texture numbered_texture()
{
    Texture texture;
    texture.size_px = {4, 2};
    for (const auto [i, x, y] : pixels_of({4, 2}))
        texture.rgba.insert(texture.rgba.end(), {uint8_t(16 * x), uint8_t(64 * y), 51, 102});
    return texture;
}

/// A quad with one texture in every place.
struct Textured {
    Scene    scene;
    Material material; // of the quad

    explicit Textured(const Texture& texture)
    {
        add_quad(scene, add_material(scene, {1, 1, 1}, 1), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        scene.textures = {texture};
        material       = scene.materials[0];
        for (TextureUse* use :
             {&material.base_colour_texture, &material.metallic_roughness_texture, &material.emissive_texture})
            use->texture = 0;
    }

    SurfaceMaterial at(SurfacePoint point)
    {
        scene.materials[0] = material;
        return surface_material(scene, point);
    }

    /// Column and row of what the base colour shows at these texture coordinates.
    glm::vec2 place(glm::vec2 uv)
    {
        material.base_colour_texture.uv_transform = glm::mat3({1, 0, 0}, {0, 1, 0}, {uv, 1});
        const glm::vec3 colour                    = at({}).base_colour; // the corner whose coordinates are 0
        return {colour.r * 255 / 16, colour.g * 255 / 64};
    }
};

void expect_place(glm::vec2 found, glm::vec2 expected)
{
    // A byte is divided by 255 and multiplied by it again, in float.
    EXPECT_NEAR(found.x, expected.x, 1e-5);
    EXPECT_NEAR(found.y, expected.y, 1e-5);
}

TEST(SceneSurface, NearestTexelsWrapAsTold)
{
    Texture texture = numbered_texture();
    texture.nearest = true;
    // Columns -1, 4, 5 and 8 of four; rows -1, 2, 3 and 4 of two.
    const glm::vec2 places[] = {{-0.125F, -0.25F}, {1.125F, 1.25F}, {1.375F, 1.75F}, {2.125F, 2.25F}};
    const struct {
        Wrap mode;
        int  columns[4], rows[4];
    } modes[] = {{Wrap::repeat, {3, 0, 1, 0}, {1, 0, 1, 0}},
                 {Wrap::clamp_to_edge, {0, 3, 3, 3}, {0, 1, 1, 1}},
                 {Wrap::mirrored_repeat, {0, 3, 2, 0}, {0, 1, 0, 0}}};
    for (const auto& u : modes)
        for (const auto& v : modes) {
            texture.wrap_u = u.mode;
            texture.wrap_v = v.mode;
            Textured quad(texture);
            for (int i = 0; i < 4; ++i) expect_place(quad.place(places[i]), {u.columns[i], v.rows[i]});
        }
}

TEST(SceneSurface, TexelsAreMixedBetweenTheirCentres)
{
    Textured quad(numbered_texture());
    expect_place(quad.place({0.125F, 0.25F}), {0, 0}); // the centre of texel (0, 0)
    expect_place(quad.place({0.25F, 0.25F}), {0.5F, 0});
    expect_place(quad.place({0.3125F, 0.25F}), {0.75F, 0});
    expect_place(quad.place({0.125F, 0.375F}), {0, 0.25F});
    expect_place(quad.place({0, 0.25F}), {1.5F, 0}); // between the last column and the first
    Texture clamped = numbered_texture();
    clamped.wrap_u = clamped.wrap_v = Wrap::clamp_to_edge;
    expect_place(Textured(clamped).place({0, 0}), {0, 0});
}

TEST(SceneSurface, ChannelsMultiplyFactors)
{
    Textured quad(numbered_texture());
    for (Vertex& vertex : quad.scene.vertices) vertex.colour = {1, 1, 0.5F, 0.5F};
    quad.material.base_colour   = {1, 1, 0.5F, 0.5F};
    quad.material.metallic      = 0.5F;
    quad.material.roughness     = 0.5F;
    quad.material.emissive      = {1, 1, 2};
    quad.material.dielectric_f0 = 0.25F;
    for (TextureUse* use : {&quad.material.base_colour_texture, &quad.material.metallic_roughness_texture,
                            &quad.material.emissive_texture})
        use->uv_transform = glm::mat3({1, 0, 0}, {0, 1, 0}, {0.125F, 0.75F, 1}); // the centre of texel (0, 1)
    const SurfaceMaterial found = quad.at({});
    EXPECT_NEAR(found.base_colour.b, 0.2F / 4, 1e-6);
    EXPECT_NEAR(surface_colour(quad.scene, {}).a, 0.4F / 4, 1e-6);
    EXPECT_NEAR(found.metallic, 0.2F / 2, 1e-6);         // blue
    EXPECT_NEAR(found.roughness, 64.0F / 255 / 2, 1e-6); // green
    EXPECT_NEAR(found.emissive.b, 0.2F * 2, 1e-6);
    EXPECT_EQ(found.dielectric_f0, 0.25F);
    // Of the encoding: 51 / 255 is 0.2, ((0.2 + 0.055) / 1.055)^2.4 = 0.0331; alpha stays.
    quad.scene.textures[0].srgb = true;
    EXPECT_NEAR(quad.at({}).emissive.b, 2 * std::pow(0.255 / 1.055, 2.4), 1e-6);
    EXPECT_NEAR(surface_colour(quad.scene, {}).a, 0.4F / 4, 1e-6);
    quad.scene.textures[0].rgba[4 * 4 + 2] = 5; // below 0.04045 it is a line
    EXPECT_NEAR(quad.at({}).emissive.b, 2 * 5 / 255.0 / 12.92, 1e-6);
}

// A map that leans by 3 to 4 towards its x or its y; the quad's normal is z.
TEST(SceneSurface, NormalMapsTurnTheNormal)
{
    const auto leaning = [](uint8_t x, uint8_t y) {
        Texture texture;
        texture.size_px = {1, 1};
        texture.rgba    = {x, y, 230, 255}; // 0.8 is 229.5
        return texture;
    };
    const auto normal = [&](const Texture& texture, glm::vec4 tangent, float scale = 1) {
        Textured quad(texture);
        for (Vertex& vertex : quad.scene.vertices) vertex.tangent_ws = tangent;
        quad.material.normal_texture.texture = 0;
        quad.material.normal_scale           = scale;
        return quad.at({}).normal_ws;
    };
    constexpr double texel = 0.01;
    const auto near = [&](glm::dvec3 found, glm::dvec3 expected) { EXPECT_LT(glm::length(found - expected), texel); };
    near(normal(leaning(204, 128), {1, 0, 0, 1}), {0.6, 0, 0.8});
    near(normal(leaning(204, 128), {0, 1, 0, 1}), {0, 0.6, 0.8});
    near(normal(leaning(128, 204), {1, 0, 0, 1}), {0, 0.6, 0.8});
    near(normal(leaning(128, 204), {1, 0, 0, -1}), {0, -0.6, 0.8});
    near(normal(leaning(204, 128), {1, 0, 0, 1}, 0), {0, 0, 1});
    near(normal(leaning(204, 128), {0, 0, 0, 0}), {0, 0, 1}); // no tangents
}

TEST(SceneSurface, VerticesAreMixedByTheirWeights)
{
    Textured quad(numbered_texture());
    for (size_t i = 0; i < 4; ++i) {
        quad.scene.vertices[i].colour    = {i == 0, i == 1, i == 2, 1};
        quad.scene.vertices[i].uv1       = {0.125F + 0.25F * float(i), 0.25F};
        quad.scene.vertices[i].normal_ws = glm::vec3(i == 0, i == 1, i == 2) * 2.0F;
    }
    quad.material.base_colour_texture = {};
    const SurfacePoint    point{0, 0, {0.25, 0.5}}; // of the second and the third corner; the first has a quarter
    const SurfaceMaterial found = quad.at(point);
    EXPECT_EQ(found.base_colour, glm::vec3(0.25F, 0.25F, 0.5F));
    EXPECT_LT(glm::distance(found.normal_ws, glm::normalize(glm::dvec3(1, 1, 2))), 1e-6);
    EXPECT_EQ(quad.at({0, 1, {1, 0}}).base_colour, glm::vec3(0, 0, 1))
        << "the second triangle begins with corners 0 and 2";
    EXPECT_EQ(corner_ws(quad.scene, {0, 1, {}}, 2), glm::dvec3(0, 1, 0));
    quad.material.base_colour_texture = {.texture = 0, .uv_set = 1};
    for (Vertex& vertex : quad.scene.vertices) vertex.colour = glm::vec4(1);
    EXPECT_NEAR(quad.at({0, 0, {0, 1}}).base_colour.r * 255 / 16, 2, 1e-5) << "the second set of coordinates";
    for (Vertex& vertex : quad.scene.vertices) vertex.normal_ws = {};
    EXPECT_EQ(shading_normal_ws(quad.scene, point), glm::dvec3(0));
}

/// What a white floor at y = 0 shows straight below (0, 1, 0), times pi.
double irradiance_of(const Light& light)
{
    Scene scene;
    scene.ambient = glm::vec3(0);
    add_quad(scene, add_material(scene, {1, 1, 1}, 0), {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    scene.lights = {light};
    const SceneRay ray{{0, 1, 0}, {0, -1, 0}, 0, 10};
    SceneHit       hit;
    const SceneBvh bvh(scene);
    bvh.intersect({&ray, 1}, {&hit, 1});
    return std::numbers::pi * double(shade_point(bvh, scene, hit, {0, 0, 0}, ray.direction_ws).x);
}

TEST(SceneSurface, LightsFadeWithTheirRangeAndTheirCone)
{
    Light light;
    light.type        = LightType::point;
    light.position_ws = {0, 2, 0};
    light.intensity   = glm::vec3(8);
    EXPECT_NEAR(irradiance_of(light), 8 / 4.0, 1e-5);
    light.range_m = 4; // KHR_lights_punctual: max(min(1 - (2 / 4)^4, 1), 0)
    EXPECT_NEAR(irradiance_of(light), 8 / 4.0 * (1 - 1 / 16.0), 1e-5);
    light.range_m = 1.9F;
    EXPECT_EQ(irradiance_of(light), 0);
    light.range_m         = 0;
    light.type            = LightType::spot;
    light.inner_angle_rad = 0.25F;
    light.outer_angle_rad = 0.75F;
    for (const double angle : {0.0, 0.2, 0.5, 0.7, 0.8}) {
        light.direction_ws  = {std::sin(angle), -std::cos(angle), 0};
        const double cone   = (std::cos(angle) - std::cos(0.75)) / (std::cos(0.25) - std::cos(0.75)),
                     within = std::min(std::max(cone, 0.0), 1.0);
        EXPECT_NEAR(irradiance_of(light), 8 / 4.0 * within * within, 1e-5) << angle;
    }
}

} // namespace
} // namespace ssrlab
