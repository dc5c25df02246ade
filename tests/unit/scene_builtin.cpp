#include "scene_files.h"

#include "core/pixel_index.h"
#include "scene/model.h"

namespace ssrlab {
namespace {

const Draw& draw_named(const Scene& scene, const std::string& name)
{
    for (const Draw& draw : scene.draws)
        if (draw.name == name) return draw;
    throw Failure("no draw " + name);
}

glm::dvec3 to_px(const View& view, glm::dvec3 position_ws)
{
    return vs_to_px(view, glm::dvec3(view.world_to_view * glm::dvec4(position_ws, 1)));
}

TEST(SceneBuiltin, AllLoadWithLightsAndNamedViews)
{
    for (const SceneListing& listing : list_scenes()) {
        if (!listing.name.starts_with("builtin:")) continue;
        const Scene scene = load_scene(listing.name);
        EXPECT_EQ(scene.name, listing.name);
        EXPECT_FALSE(listing.summary.empty());
        EXPECT_TRUE(scene.warnings.empty()) << listing.name << ": " << scene.warnings.front();
        EXPECT_FALSE(scene.lights.empty());
        EXPECT_EQ(scene.origin_ws, glm::dvec3(0));
        for (const Camera& camera : scene.cameras) {
            EXPECT_FALSE(camera.hard_for.empty());
            EXPECT_NO_THROW(camera_to_view(camera, {641, 363}));
        }
        EXPECT_GE(scene.cameras.size(), listing.name == "builtin:void" ? 1U : 3U) << listing.name;
    }
}

constexpr const char* analytic_scenes[] = {"builtin:mirror_floor_wall", "builtin:sphere_over_mirror",
                                           "builtin:pole_field", "builtin:stairs", "builtin:corridor"};

TEST(SceneBuiltin, AnalyticScenesHaveOneMirrorTheirFloor)
{
    for (const char* name : analytic_scenes) {
        const Scene scene = load_scene(name);
        const Draw& floor = draw_named(scene, "floor");
        EXPECT_EQ(floor.bounds_min_ws.y, -1);
        EXPECT_EQ(floor.bounds_max_ws.y, -1);
        EXPECT_EQ(scene.materials[floor.material].metallic, 1);
        EXPECT_EQ(scene.materials[floor.material].roughness, 0);
        for (const Draw& draw : scene.draws)
            EXPECT_EQ(scene.materials[draw.material].metallic, draw.name == "floor" ? 1 : 0) << draw.name;
    }
}

TEST(SceneBuiltin, FrontsFaceAlongTheirNormals)
{
    for (const SceneListing& listing : list_scenes()) {
        if (!listing.name.starts_with("builtin:")) continue;
        const Scene scene = load_scene(listing.name);
        size_t      wrong = 0;
        for (size_t i = 0; i < scene.indices.size(); i += 3)
            for (size_t k = i; k < i + 3; ++k)
                if (glm::dot(geometric_normal(scene, i / 3), scene.vertices[scene.indices[k]].normal_ws) < 0.9F)
                    ++wrong;
        EXPECT_EQ(wrong, 0U) << listing.name;
    }
}

TEST(SceneBuiltin, FloorAndWallReflectAsTheClosedFormSays)
{
    const Scene scene = load_scene("builtin:mirror_floor_wall");
    const View  view  = camera_to_view(find_camera(scene, "default"), {64, 64});
    EXPECT_EQ(draw_named(scene, "wall").bounds_min_ws.z, -10);
    EXPECT_EQ(draw_named(scene, "wall").bounds_max_ws.z, -10);
    for (double distance_m : {1.5, 2.0, 5.0, 9.0}) {
        const double     py   = to_px(view, {0, -1, -distance_m}).y;
        const glm::dvec3 wall = {0, -2 + 10 / distance_m, -10}; // straight on from the mirrored camera
        EXPECT_NEAR(to_px(view, wall).y, 1.1 * 64 - py, 1e-9);
        EXPECT_LT(wall.y, draw_named(scene, "wall").bounds_max_ws.y);
    }
}

TEST(SceneBuiltin, TheSphereIsASphereThatTouchesTheFloor)
{
    const Scene scene  = load_scene("builtin:sphere_over_mirror");
    const Draw& sphere = draw_named(scene, "sphere");
    EXPECT_NEAR(sphere.bounds_min_ws.y, -1, 1e-6);
    for (uint32_t i = sphere.first_index; i < sphere.first_index + sphere.index_count; ++i) {
        const Vertex&   vertex = scene.vertices[scene.indices[i]];
        const glm::vec3 radial = vertex.position_ws - glm::vec3(0, 0, -5);
        ASSERT_NEAR(glm::length(radial), 1, 1e-6);
        ASSERT_VEC_NEAR(vertex.normal_ws, radial, 1e-5F);
    }
}

TEST(SceneBuiltin, PolesStandWhereTheHeaderSays)
{
    const Scene scene = load_scene("builtin:pole_field");
    size_t      poles = 0;
    for (const Draw& draw : scene.draws)
        if (draw.name.starts_with("pole")) poles += draw.index_count;
    EXPECT_EQ(poles, 6U * 25 * 12 * 4 * 3) << "6 rows of 25 poles with 12 sides: 2 triangles a side, 1 + 1 in the caps";
    const View view = camera_to_view(scene.cameras[0], {640, 360});
    EXPECT_NEAR(to_px(view, {0.5, -1, -3}).x, to_px(view, {0.5, -2.7, -3}).x, 1e-9)
        << "a pole's reflection has its column";
}

/// Roughness and metallic of the ground's texel at a point, as builtin:puddle stores them.
glm::vec2 puddle_gloss(const Scene& scene, glm::dvec2 point_xz)
{
    const Draw&    ground = draw_named(scene, "ground");
    const Texture& texture =
        scene.textures.at(static_cast<size_t>(scene.materials[ground.material].metallic_roughness_texture.texture));
    const glm::ivec2 texel((point_xz - glm::dvec2(-6.5, -11.3)) / 13.0 * glm::dvec2(texture.size_px));
    const uint8_t*   bytes = &texture.rgba[4 * pixel_index(texel, texture.size_px)];
    return glm::vec2(bytes[1], bytes[2]) / 255.0F;
}

TEST(SceneBuiltin, PuddlesAreSmoothInsideAndRoughOutside)
{
    const Scene scene = load_scene("builtin:puddle");
    // Along the first puddle's ray a = 0 the border lies at R (1 + 0.28 sin 0.4 + 0.13 sin 1.3 + 0.06 sin 2).
    const double border_m = 1.9 * (1 + 0.28 * std::sin(0.4) + 0.13 * std::sin(1.3) + 0.06 * std::sin(2.0));
    for (const double inside_m : {0.0, 1.0, border_m - 0.03}) {
        const glm::vec2 gloss = puddle_gloss(scene, {0.3 + inside_m, -3.9});
        EXPECT_NEAR(gloss.x, 0.03F, 0.002F) << inside_m;
        EXPECT_EQ(gloss.y, 1) << inside_m;
    }
    for (const double outside_m : {border_m + 0.03, border_m + 0.2}) {
        const glm::vec2 gloss = puddle_gloss(scene, {0.3 + outside_m, -3.9});
        EXPECT_GE(gloss.x, 0.598F) << outside_m;
        EXPECT_LE(gloss.x, 0.702F) << outside_m;
        EXPECT_NEAR(gloss.y, 0.4F, 0.002F) << outside_m;
    }
    // Texture rows run away from the camera's side: the small puddles lie where they should.
    EXPECT_EQ(puddle_gloss(scene, {-3.1, -2.2}).y, 1);
    EXPECT_EQ(puddle_gloss(scene, {3.4, -5.6}).y, 1);
    EXPECT_LT(puddle_gloss(scene, {-3.1, -7.4}).y, 1);
}

TEST(SceneBuiltin, GlossStepsRiseByATenth)
{
    const Scene scene = load_scene("builtin:gloss_steps");
    int         k     = 0;
    for (const Draw& draw : scene.draws) {
        if (draw.name != "strip") continue;
        EXPECT_NEAR(scene.materials[draw.material].roughness, 0.1F * static_cast<float>(k), 1e-6F);
        EXPECT_NEAR(draw.bounds_min_ws.x, -4.12F + 1.03F * static_cast<float>(k), 1e-5F);
        ++k;
    }
    EXPECT_EQ(k, 8);
}

// Straight lines from the eye over the board's edges, and from its mirror image under the board.
TEST(SceneBuiltin, TheBoardHidesTheShelfAndTheMirrorShowsIt)
{
    const Scene      scene   = load_scene("builtin:hidden_shelf");
    const glm::dvec3 eye     = find_camera(scene, "default").position_ws;
    const Draw&      board   = draw_named(scene, "board");
    const auto       on_wall = [&](double eye_y, double edge_y) {
        const double share = (eye.z + 7.3) / (eye.z - static_cast<double>(board.bounds_max_ws.z));
        return eye_y + (edge_y - eye_y) * share;
    };
    const Draw& cans = draw_named(scene, "cans");
    EXPECT_LT(on_wall(eye.y, static_cast<double>(board.bounds_min_ws.y)), static_cast<double>(cans.bounds_min_ws.y));
    EXPECT_GT(on_wall(eye.y, static_cast<double>(board.bounds_max_ws.y)), static_cast<double>(cans.bounds_max_ws.y));
    EXPECT_GT(on_wall(-2 - eye.y, static_cast<double>(board.bounds_min_ws.y)),
              static_cast<double>(cans.bounds_max_ws.y));
}

TEST(SceneBuiltin, NothingMetallicInMatte)
{
    for (const Material& material : load_scene("builtin:matte").materials) EXPECT_EQ(material.metallic, 0);
}

TEST(SceneBuiltin, VoidIsValidAndEmpty)
{
    const Scene scene = load_scene("builtin:void");
    EXPECT_TRUE(scene.indices.empty());
    EXPECT_TRUE(scene.draws.empty());
    EXPECT_EQ(scene.cameras.size(), 1U);
}

TEST(SceneBuiltin, UnknownNamesListTheKnown)
{
    EXPECT_THAT(error_of<SpecError>("builtin:nothing"), ::testing::HasSubstr("builtin:void"));
    EXPECT_THAT(error_of<SpecError>("no_such_scene"), ::testing::HasSubstr("thin_yard"));
    EXPECT_THAT(error_of<SpecError>("no/such/file.glb"), ::testing::HasSubstr("no such file"));
    EXPECT_THAT(error_of<SpecError>(""), ::testing::HasSubstr("unknown scene"));
}

} // namespace
} // namespace ssrlab
