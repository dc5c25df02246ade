#include "scene_files.h"

#include "scene/model.h"

#include <cmath>

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
        if (listing.name == "builtin:void") continue;
        EXPECT_GE(scene.cameras.size(), 3U) << listing.name;
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
    for (const char* name : {"builtin:mirror_floor_wall", "builtin:sphere_over_mirror", "builtin:pole_field",
                             "builtin:stairs", "builtin:corridor"}) {
        const Scene scene = load_scene(name);
        size_t      wrong = 0;
        for (size_t i = 0; i < scene.indices.size(); i += 3)
            for (size_t k = i; k < i + 3; ++k)
                if (glm::dot(geometric_normal(scene, i / 3), scene.vertices[scene.indices[k]].normal_ws) < 0.9F)
                    ++wrong;
        EXPECT_EQ(wrong, 0U) << name;
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
