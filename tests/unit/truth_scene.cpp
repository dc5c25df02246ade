// The scene truth on scenes with closed-form reflections.
#include "core/error.h"
#include "truth/scene_truth.h"
#include "truth/screen_ray.h"
#include "truth_scenes.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr double tolerance = 1e-4; // relative

struct Case {
    Scene        scene;
    GBufferImage gbuffer = floor_and_wall(bench_view({64, 64}), 10);

    SceneTruth truth(const TraceSettings& settings = {}) const
    {
        return scene_truth(SceneBvh(scene), scene, gbuffer, settings);
    }
};

Case floor_case()
{
    Case result;
    add_floor(result.scene, add_material(result.scene, {1, 1, 1}, 1));
    add_material(result.scene, {0.5F, 0.5F, 0.5F}, 0);
    return result;
}

int count(const SceneTruth& truth, TruthClass cls) { return int(std::count(truth.cls.begin(), truth.cls.end(), cls)); }

// The ray from floor point Z0 mirrors upwards at the slope it came down: it meets the wall at Z = 10, at the height
// Y = -1 + (10 - Z0) / Z0, which is row 70.4 - py in every column.
TEST(SceneTruth, MirrorFloorAndWall)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    for (size_t i = 0; i < test.gbuffer.radiance.size(); ++i) test.gbuffer.radiance[i] = glm::vec3(float(i), 0, 0);
    const SceneTruth truth = test.truth();
    for (int y = 36; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const size_t i  = at(test.gbuffer, x, y);
            const double py = 70.4 - (y + 0.5);
            const double z0 = 32 / (y + 0.5 - 32);
            ASSERT_EQ(truth.cls[i], TruthClass::visible) << x << ' ' << y;
            EXPECT_NEAR(truth.point_px[i].y, py, tolerance * 64);
            EXPECT_NEAR(truth.point_px[i].x, x + 0.5, tolerance * 64);
            EXPECT_NEAR(truth.point_vs[i].z, -10, tolerance * 10);
            EXPECT_NEAR(truth.point_vs[i].y, -1 + (10 - z0) / z0, tolerance * 10);
            const glm::dvec2 slope((x + 0.5 - 32) / 32, (y + 0.5 - 32) / 32);
            EXPECT_NEAR(truth.distance_m[i], (10 - z0) * std::sqrt(1 + glm::dot(slope, slope)), tolerance * 30);
            EXPECT_EQ(truth.radiance[i].x, float(at(test.gbuffer, x, int(std::floor(py)))));
        }
    }
    EXPECT_EQ(count(truth, TruthClass::not_traced), 64 * 35);
    EXPECT_EQ(truth.off_surface, 0U);
}

TEST(SceneTruth, DepthsWhereTheSceneHasNoSurfaceAreCounted)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    const double floor_m[] = {32 / 13.5, 32 / 18.5}; // of rows 45 and 50
    for (int x = 0; x < 64; ++x) {
        set_pixel(test.gbuffer, x, 45, floor_m[0] * (1 + 0.5 * self_hit_share), {0, 1, 0}, 1);
        if (x < 20) set_pixel(test.gbuffer, x, 50, floor_m[1] * (1 + 2 * self_hit_share), {0, 1, 0}, 1);
        if (x > 30) set_pixel(test.gbuffer, x, 50, floor_m[1] * (1 - 2 * self_hit_share), {0, 1, 0}, 1);
    }
    const SceneTruth truth = test.truth();
    EXPECT_EQ(truth.off_surface, 20U + 33U);
    EXPECT_THAT(off_surface_share(truth), testing::Optional(53.0 / (64 * 29)));
    EXPECT_EQ(off_surface_share(SceneBvh(test.scene), test.scene, test.gbuffer, {}), off_surface_share(truth));
    EXPECT_EQ(drawn_elsewhere(off_surface_share(truth)), "");
    for (int y = 55; y < 57; ++y)
        for (int x = 0; x < 64; ++x) set_pixel(test.gbuffer, x, y, 1, {0, 1, 0}, 1);
    EXPECT_THAT(drawn_elsewhere(off_surface_share(test.truth())), testing::HasSubstr("at 10 % of the pixels"));
    EXPECT_EQ(off_surface_share(empty_scene_truth({4, 4})), std::nullopt);
}

// What else is set, of how rays are traced, leaves the truth as it is.
TEST(SceneTruth, IsAnotherWhereOtherPixelsReflectOrRaysEndElsewhere)
{
    const TraceSettings settings;
    TraceSettings       farther = settings, rougher = settings, brighter = settings, thicker = settings;
    farther.max_distance_m += 1;
    rougher.dielectric_max_roughness += 0.125;
    brighter.dielectric_min_f0 += 0.125;
    thicker.thickness_m += 1;
    for (const TraceSettings& other : {farther, rougher, brighter}) EXPECT_FALSE(same_scene_truth(settings, other));
    EXPECT_TRUE(same_scene_truth(settings, thicker));
}

TEST(SceneTruth, FloorAloneReflectsTheSky)
{
    Case test              = floor_case();
    test.gbuffer           = floor_and_wall(bench_view({64, 64}), 100);
    test.scene.background  = {0.25F, 0.5F, 0.75F};
    const SceneTruth truth = test.truth();
    EXPECT_EQ(count(truth, TruthClass::sky), 64 * 32);
    EXPECT_EQ(truth.radiance[at(test.gbuffer, 3, 63)], test.scene.background);
    EXPECT_TRUE(std::isinf(truth.distance_m[at(test.gbuffer, 3, 63)]));
}

TEST(SceneTruth, EmptySceneIsAllSky)
{
    Case test;
    EXPECT_EQ(count(test.truth(), TruthClass::sky), 64 * 29);
    test.gbuffer = empty_gbuffer(bench_view({3, 2}));
    EXPECT_EQ(count(test.truth(), TruthClass::not_traced), 6);
}

// The wall is 10 m - Z0 behind the floor point, times the slope of the ray: column 31 is nearly straight.
TEST(SceneTruth, BeyondTheMaximumDistance)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    TraceSettings settings;
    settings.max_distance_m = 5;
    const SceneTruth truth  = test.truth(settings);
    EXPECT_EQ(truth.cls[at(test.gbuffer, 31, 36)], TruthClass::visible);
    EXPECT_EQ(truth.cls[at(test.gbuffer, 31, 63)], TruthClass::beyond);
    EXPECT_EQ(count(truth, TruthClass::beyond) + count(truth, TruthClass::visible), 64 * 29);
}

// A plate at Z = 5 over Y in [1, 1.5] covers the wall's Y in [2, 3]: rows 32 (1 - 1.5/5) = 22.4 to 25.6 of the image. A ray from
// Z0 passes under it or over it: at Z = 5 it is at Y = 5/Z0 - 2, inside the plate for Z0 in [10/7, 5/3].
TEST(SceneTruth, OccluderHidesTheWall)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    add_quad(test.scene, 1, {-100, 1, -5}, {200, 0, 0}, {0, 0.5, 0});
    const SceneTruth truth = test.truth();
    for (int y = 36; y < 64; ++y) {
        const double z0       = 32 / (y + 0.5 - 32);
        const double plate    = 5 / z0 - 2;
        const double wall_y   = 10 / z0 - 2;
        const bool   on_plate = z0 < 5 && plate > 1 && plate < 1.5;
        const bool   behind   = wall_y > 2 && wall_y < 3;
        const size_t i        = at(test.gbuffer, 20, y);
        EXPECT_EQ(truth.cls[i], on_plate || !behind ? TruthClass::visible : TruthClass::hidden) << y;
        EXPECT_NEAR(truth.point_vs[i].z, on_plate ? -5 : -10, tolerance * 5) << y;
        EXPECT_NEAR(truth.point_vs[i].y, on_plate ? plate : wall_y, tolerance * 5) << y;
    }
    EXPECT_GT(count(truth, TruthClass::hidden), 0);
}

// Seen along the axis, 8 px a metre: a mirror ramp Y = Z / 2 - 5 from below up to a wall at Z = 10, and a plate at Z = 5 over Y in [1, 2],
// which covers the same Y of the wall. From Y0 of the ramp the ray goes along (0, 4, -3) / 5, behind the plate, and meets the wall at
// Y = -5/3 Y0; above 4 it is off the picture.
TEST(SceneTruth, OrthographicViewsSeeAlongTheirAxis)
{
    Case test;
    add_quad(test.scene, add_material(test.scene, {1, 1, 1}, 1), {-20, -4.5, -1}, {40, 0, 0}, {0, 4.5, -9});
    add_wall(test.scene, add_material(test.scene, {0.5F, 0.5F, 0.5F}, 0), 10);
    add_quad(test.scene, 1, {-20, 1, -5}, {40, 0, 0}, {0, 1, 0});
    View view       = bench_view({64, 64});
    view.projection = Projection::orthographic;
    view.focal_px   = {8, 8};
    view.far_m      = 30;
    test.gbuffer    = empty_gbuffer(view);
    for (int y = 32; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            set_pixel(test.gbuffer, x, y, 2 * ((31.5 - y) / 8 + 5), glm::normalize(glm::dvec3(0, 2, 1)), 1);
    const SceneTruth truth = test.truth();
    for (int y = 32; y < 64; ++y)
        for (const int x : {0, 20, 63}) {
            const size_t i      = at(test.gbuffer, x, y);
            const double y0     = (31.5 - y) / 8;
            const double wall_y = -5.0 / 3 * y0;
            EXPECT_EQ(truth.cls[i], wall_y > 4                 ? TruthClass::off_screen
                                    : wall_y > 1 && wall_y < 2 ? TruthClass::hidden
                                                               : TruthClass::visible)
                << x << ' ' << y;
            EXPECT_NEAR(truth.point_vs[i].y, wall_y, tolerance * 5) << y;
            EXPECT_NEAR(truth.point_vs[i].z, -10, tolerance * 10) << y;
            EXPECT_NEAR(truth.point_px[i].y, 32 - 8 * wall_y, tolerance * 64) << y;
            EXPECT_NEAR(truth.distance_m[i], -10.0 / 3 * y0, tolerance * 10) << y;
        }
    EXPECT_EQ(truth.off_surface, 0U);
}

// The picture shows the plate there, another colour.
TEST(SceneTruth, HiddenPointsHaveTheirOwnColour)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    add_quad(test.scene, 1, {-100, 1, -5}, {200, 0, 0}, {0, 0.5, 0});
    test.scene.materials[1].base_colour = {0, 0, 0, 1};
    test.scene.materials[1].emissive    = {0.25F, 0, 0};
    for (int y = 22; y < 26; ++y) // 32 (1 - Y / Z) of the plate's borders: 22.4 and 25.6
        for (int x = 0; x < 64; ++x) set_pixel(test.gbuffer, x, y, 5, {0, 0, 1}, 0);
    std::ranges::fill(test.gbuffer.radiance, glm::vec3(0, 7, 0));
    const SceneTruth truth = test.truth();
    EXPECT_GT(count(truth, TruthClass::hidden), 0);
    int in_the_picture = 0;
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        if (truth.cls[i] == TruthClass::not_traced) continue;
        // The wall above and below the plate has parts in the plate's pixels.
        const bool shown =
            truth.cls[i] == TruthClass::visible &&
            std::abs(-pixel_point_vs(test.gbuffer, glm::ivec2(truth.point_px[i])).z + truth.point_vs[i].z) < 1;
        in_the_picture += shown;
        EXPECT_EQ(truth.radiance[i], shown ? glm::vec3(0, 7, 0) : glm::vec3(0.25F, 0, 0)) << i;
    }
    EXPECT_GT(in_the_picture, 100);
}

// Red posts on a green floor before a blue wall. Where a reflected ray meets a post near its edge, the pixel there shows the floor or the wall.
TEST(SceneTruth, SilhouettesDoNotLeak)
{
    Case test;
    for (const glm::vec3& glow : {glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(1, 0, 0)}) {
        const uint32_t material                 = add_material(test.scene, {0, 0, 0}, glow.g);
        test.scene.materials[material].emissive = glow;
    }
    add_floor(test.scene, 0);
    add_wall(test.scene, 1, 10);
    for (double x_m = -7.9; x_m < 8; x_m += 0.83) add_quad(test.scene, 2, {x_m, -1, -6}, {0.37, 0, 0}, {0, 1.4, 0});
    const glm::vec3 colours[] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    const SceneBvh  bvh(test.scene);
    for (const auto [i, x, y] : pixels_of({64, 64})) { // what the camera sees at the pixel's centre
        const SceneRay ray{{0, 0, 0}, {(x + 0.5 - 32) / 32, -(y + 0.5 - 32) / 32, -1}, 0.1, 1e9};
        SceneHit       hit;
        bvh.intersect({&ray, 1}, {&hit, 1});
        ASSERT_TRUE(hit.met);
        const uint32_t material = test.scene.draws[hit.surface.draw].material;
        set_pixel(test.gbuffer, x, y, hit.t, glm::normalize(hit.normal_ws), float(material == 0));
        test.gbuffer.radiance[at(test.gbuffer, x, y)]  = colours[material];
        test.gbuffer.object_id[at(test.gbuffer, x, y)] = hit.surface.draw + 1;
    }
    const SceneTruth truth   = test.truth();
    int              on_post = 0, leaks = 0, elsewhere = 0;
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        if (truth.cls[i] != TruthClass::visible || std::abs(truth.point_vs[i].z + 6) > 0.01) continue;
        ++on_post;
        leaks += truth.radiance[i] != glm::vec3(1, 0, 0);
        elsewhere += test.gbuffer.radiance[pixel_index(glm::ivec2(truth.point_px[i]), {64, 64})] != glm::vec3(1, 0, 0);
    }
    EXPECT_GT(on_post, 100);
    EXPECT_GT(elsewhere, 10) << "pixels of other surfaces, where it leaked";
    EXPECT_EQ(leaks, 0);
}

TEST(SceneTruth, WhatLiesBeforeTheNearPlaneHidesNothing)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    add_quad(test.scene, 1, {-100, -100, -0.5 * test.gbuffer.view.near_m}, {200, 0, 0}, {0, 200, 0});
    test.scene.materials[1].double_sided = true;
    EXPECT_EQ(count(test.truth(), TruthClass::visible), 64 * 29);
}

// The camera looks into a room through the back of a wall that the rasteriser culls: that wall hides nothing.
TEST(SceneTruth, CulledBackHidesNothing)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    add_quad(test.scene, 1, {-100, -0.9, -0.5}, {0, 100, 0}, {200, 0, 0}); // front away from the camera
    EXPECT_EQ(count(test.truth(), TruthClass::visible), 64 * 29);
    test.scene.materials[1].double_sided = true;
    EXPECT_GT(count(test.truth(), TruthClass::hidden), 64 * 20);
}

TEST(SceneTruth, WhatTheCameraSeesFromItsEdgeIsNotVisible)
{
    for (const double height_m : {0.0, 1e-8, -1e-8}) {
        for (const bool front_down : {true, false}) {
            Case             test = floor_case();
            const glm::dvec3 across(2000, 0, 0), along(0, 0, 4000);
            add_quad(test.scene, 1, {-1000, height_m, -2000}, front_down ? across : along, front_down ? along : across);
            test.scene.materials[1].double_sided = true;
            const SceneTruth truth               = test.truth();
            EXPECT_EQ(count(truth, TruthClass::visible), 0) << height_m << ' ' << front_down;
            EXPECT_GT(count(truth, TruthClass::facing_away), 64 * 20) << height_m << ' ' << front_down;
        }
    }
}

// A ceiling at y = 30 is met at Z = Z0 + 31 Z0 = 32 Z0 and projects to py = 32 (1 - 30 / (32 Z0)): outside for Z0 < 30/32.
// A wall that looks away shows ray and camera the same back, which the frame draws only if the material is double-sided.
TEST(SceneTruth, OffScreenAndBackSide)
{
    Case test                     = floor_case();
    test.gbuffer                  = floor_and_wall(bench_view({64, 80}), 1e6); // rows to 79.5: Z0 down to 40 / 39.5 ...
    test.gbuffer.view.centre_px.y = 20;                                        // ... and now down to 40 / 59.5
    test.gbuffer                  = floor_and_wall(test.gbuffer.view, 50);
    add_quad(test.scene, 1, {-1000, 30, -2000}, {2000, 0, 0}, {0, 0, 4000}); // front down
    const SceneTruth truth = test.truth();
    for (int y = 21; y < 80; ++y) {
        const double z0 = 40 / (y + 0.5 - 20);
        const double py = 20 - 40 * 30 / (32 * z0);
        const size_t i  = at(test.gbuffer, 32, y);
        EXPECT_EQ(truth.cls[i], py < 0 ? TruthClass::off_screen : TruthClass::visible) << y;
    }
    EXPECT_GT(count(truth, TruthClass::off_screen), 0);

    Case back = floor_case();
    add_quad(back.scene, 1, {-200, -200, -10}, {0, 400, 0}, {400, 0, 0});
    EXPECT_EQ(count(back.truth(), TruthClass::facing_away), 64 * 29);
    back.scene.materials[1].double_sided = true;
    EXPECT_EQ(count(back.truth(), TruthClass::visible), 64 * 29);
}

// A mirror straight ahead sends the ray back past the camera: what it meets there is behind the near plane.
TEST(SceneTruth, BehindTheCamera)
{
    Case test;
    test.gbuffer            = empty_gbuffer(bench_view({64, 64}));
    const uint32_t material = add_material(test.scene, {1, 1, 1}, 0);
    add_quad(test.scene, material, {-100, -100, 7}, {0, 200, 0}, {200, 0, 0}); // behind, facing the scene
    for (int x = 0; x < 64; ++x) set_pixel(test.gbuffer, x, 40, 3, {0, 0, 1}, 1);
    const SceneTruth truth = test.truth();
    EXPECT_EQ(count(truth, TruthClass::behind_camera), 64);
    EXPECT_NEAR(truth.point_vs[at(test.gbuffer, 10, 40)].z, 7, 1e-3);
}

// A block between floor point and wall, seen from the front: rays that pass over it and fall on its rear would need a mirror
// behind it. Here the mirror is the wall at Z = 20: its rays come back and meet the rear of a plate at Z = 10.
TEST(SceneTruth, RearSideFacesAway)
{
    Case test;
    test.gbuffer            = empty_gbuffer(bench_view({64, 64}));
    const uint32_t material = add_material(test.scene, {1, 1, 1}, 0);
    add_quad(test.scene, material, {-2, -2, -10}, {4, 0, 0}, {0, 4, 0}); // rows 25.6 .. 38.4 of the image
    // From (X, Y, 20) the ray comes back to X (1 + 1/2) at Z = 10: the plate for |X| < 4/3, |px - 32| < 2.13. There the
    // camera sees the plate itself, so only pixels that look past it can reflect its rear: none. A mirror to the right that is
    // turned towards it does: 45 degrees at (10, 0, -20), normal (-1, 0, 1).
    set_pixel(test.gbuffer, 47, 32, 20,
              glm::normalize(glm::dvec3(0, 0, -10) - glm::dvec3(9.6875, -0.3125, -20)) -
                  glm::normalize(glm::dvec3(9.6875, -0.3125, -20)),
              1);
    const SceneTruth truth = test.truth();
    const size_t     i     = at(test.gbuffer, 47, 32);
    EXPECT_EQ(truth.cls[i], TruthClass::facing_away);
    EXPECT_NEAR(truth.point_vs[i].x, 0, 1e-3);
    EXPECT_NEAR(truth.point_vs[i].y, 0, 1e-3);
    EXPECT_NEAR(truth.point_vs[i].z, -10, 1e-3);
}

// Sphere of radius 1 at (0, 0, -5) on the mirror floor, rays in the plane x = 0 (hence the view moved by half a pixel). From
// (-1, -Z0) along (1, -Z0) the nearer root of (-1 + s)^2 + (5 - Z0 - s Z0)^2 = 1 is the point (Y, Z) = (-1 + s, Z0 (1 + s)),
// seen at py = 32 (1 - Y / Z).
TEST(SceneTruth, SphereOnMirror)
{
    Case test = floor_case();
    add_sphere(test.scene, 1, {0, 0, -5}, 1, 400);
    View view        = bench_view({64, 64});
    view.centre_px.x = 32.5;
    for (const double py : {39.5, 41.5, 45.5, 50.5}) {
        test.gbuffer    = empty_gbuffer(view);
        const auto   y  = static_cast<int>(py);
        const size_t i  = at(test.gbuffer, 32, y);
        const double z0 = 32 / (py - 32);
        set_pixel(test.gbuffer, 32, y, z0, {0, 1, 0}, 1);
        const double     half_b = 1 + (5 - z0) * z0, a = 1 + z0 * z0, c = (5 - z0) * (5 - z0);
        const double     s = (half_b - std::sqrt(half_b * half_b - a * c)) / a, hit_y = -1 + s, hit_z = z0 * (1 + s);
        const SceneTruth truth = test.truth();
        EXPECT_EQ(truth.cls[i], TruthClass::visible) << py;
        EXPECT_NEAR(truth.point_vs[i].x, 0, tolerance * hit_z) << py;
        EXPECT_NEAR(truth.point_vs[i].y, hit_y, tolerance * hit_z) << py;
        EXPECT_NEAR(truth.point_vs[i].z, -hit_z, tolerance * hit_z) << py;
        EXPECT_NEAR(truth.point_px[i].y, 32 * (1 - hit_y / hit_z), 2e-3) << py;
        EXPECT_NEAR(truth.distance_m[i], s * std::sqrt(a), tolerance * s * std::sqrt(a)) << py;
    }
    // One row higher the point lies on the sphere's underside, which the camera cannot see: lost information, not an error.
    test.gbuffer   = empty_gbuffer(view);
    const size_t i = at(test.gbuffer, 32, 38);
    set_pixel(test.gbuffer, 32, 38, 32 / 6.5, {0, 1, 0}, 1);
    const SceneTruth truth = test.truth();
    EXPECT_EQ(truth.cls[i], TruthClass::facing_away);
    EXPECT_NEAR(truth.point_px[i].y, 38.472, 5e-3);
}

TEST(SceneTruth, AlphaMaskLetsRaysThrough)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    Texture texture;
    texture.size_px = {2, 1};
    texture.nearest = true;
    texture.rgba    = {255, 255, 255, 255, 255, 255, 255, 0}; // left half opaque, right half not
    test.scene.textures.push_back(texture);
    const uint32_t masked                                    = add_material(test.scene, {1, 1, 1}, 0);
    test.scene.materials[masked].alpha_mask                  = true;
    test.scene.materials[masked].base_colour_texture.texture = 0;
    add_quad(test.scene, masked, {-50, -50, -8}, {100, 0, 0}, {0, 100, 0});
    const SceneTruth truth = test.truth();
    for (int y = 37; y < 64; ++y) { // Z0 < 8
        EXPECT_NEAR(truth.point_vs[at(test.gbuffer, 10, y)].z, -8, 1e-3) << y;
        EXPECT_NEAR(truth.point_vs[at(test.gbuffer, 50, y)].z, -10, 1e-3) << y;
        EXPECT_EQ(truth.cls[at(test.gbuffer, 50, y)], TruthClass::visible) << y;
    }
}

// Irradiance 2 at 60 degrees on base colour 0.5: 0.5 / pi * 2 * cos 60 + ambient * 0.5 + emissive; in shadow without the first term.
TEST(SceneTruth, ShadesWithShadows)
{
    Scene scene;
    scene.ambient                      = glm::vec3(0.1F);
    const uint32_t material            = add_material(scene, {0.5F, 0.5F, 0.5F}, 0);
    scene.materials[material].emissive = {0, 0, 3};
    add_quad(scene, material, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    Light light;
    light.intensity    = {2, 2, 2};
    light.direction_ws = glm::normalize(glm::vec3(std::sqrt(3.0F), -1, 0));
    scene.lights.push_back(light);
    const SceneRay ray{{0, 1, 0}, {0, -1, 0}, 0, 10};
    SceneHit       hit;
    const auto     shade = [&] {
        const SceneBvh bvh(scene);
        bvh.intersect({&ray, 1}, {&hit, 1});
        EXPECT_TRUE(hit.met);
        return shade_point(bvh, scene, hit, {0, 0, 0}, ray.direction_ws);
    };
    const float lit = 0.5F / std::numbers::pi_v<float>;
    EXPECT_NEAR(shade().x, lit + 0.05F, 1e-5);
    EXPECT_NEAR(shade().z, lit + 3.05F, 1e-5);
    add_quad(scene, material, {-2, -3, -3}, {0, 6, 0}, {0, 0, 6}); // between the point and the light
    EXPECT_NEAR(shade().x, 0.05F, 1e-5);
    scene.lights[0].casts_shadow = false;
    EXPECT_NEAR(shade().x, lit + 0.05F, 1e-5);
    scene.lights[0] = Light{LightType::point, {0, 2, 0}, {0, -1, 0}, {8, 8, 8}, 0, 0, 0, true};
    EXPECT_NEAR(shade().x, 0.5F / std::numbers::pi_v<float> * 2 + 0.05F, 1e-5); // 8 / 2^2, straight from above
    scene.materials[material].metallic = 0.75F;
    EXPECT_NEAR(shade().x, 0.25F * 0.5F / std::numbers::pi_v<float> * 2 + 0.05F, 1e-5); // metal has no diffuse part
}

// Seen along the mirror image of the light at 60 degrees: D = 1 / (pi a^4), and the visibility of G. Smith's separable form.
TEST(SceneTruth, HighlightsAreThoseOfTheMicrofacetModel)
{
    Scene          scene;
    const uint32_t material = add_material(scene, {0.5F, 0.5F, 0.5F}, 1);
    const double   root3    = std::numbers::sqrt3;
    add_quad(scene, material, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
    Light light;
    light.intensity    = {2, 2, 2};
    light.direction_ws = glm::normalize(glm::vec3(root3, -1, 0));
    scene.lights.push_back(light);
    const SceneRay ray{{root3, 1, 0}, {-root3, -1, 0}, 0, 10};
    SceneHit       hit;
    const auto     highlight = [&](double roughness) {
        const SceneBvh bvh(scene);
        bvh.intersect({&ray, 1}, {&hit, 1});
        EXPECT_TRUE(hit.met);
        return double(shade_highlight(bvh, scene, hit, {0, 0, 0}, ray.direction_ws, roughness).x);
    };
    for (const double roughness : {0.3, 0.6, 1.0}) {
        const double a2 = std::pow(roughness, 4), cosine = 0.5, to_root = std::sqrt(a2 + (1 - a2) * cosine * cosine);
        const double facets = 1 / (std::numbers::pi * a2), visibility = 0.5 / (2 * cosine * to_root),
                     fresnel  = 0.5 + 0.5 * std::pow(1 - cosine, 5);
        const double expected = 2 * fresnel * facets * visibility * cosine;
        EXPECT_NEAR(highlight(roughness) / expected, 1, 1e-5) << roughness;
    }
    add_quad(scene, material, {-2, -3, -3}, {0, 6, 0}, {0, 0, 6}); // between the point and the light
    EXPECT_EQ(highlight(0.3), 0);
}

TEST(SceneTruth, HostileInputDoesNotAbort)
{
    Case test = floor_case();
    add_wall(test.scene, 1, 10);
    test.scene.vertices[0].position_ws.x            = std::numeric_limits<float>::quiet_NaN();
    test.scene.vertices[1].position_ws.y            = std::numeric_limits<float>::infinity();
    test.gbuffer.normal_vs[at(test.gbuffer, 3, 50)] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    const SceneTruth truth                          = test.truth();
    EXPECT_EQ(truth.cls[at(test.gbuffer, 3, 50)], TruthClass::not_traced);
    EXPECT_EQ(truth.cls[at(test.gbuffer, 4, 50)], TruthClass::visible);
    test.scene.indices[2] = 4711;
    EXPECT_THROW(SceneBvh(test.scene), Failure);
    const double   nan = std::numeric_limits<double>::quiet_NaN();
    const Scene    empty;
    const SceneRay ray{{nan, 0, 0}, {0, 0, 1}, 0, 1};
    SceneHit       hit;
    SceneBvh(empty).intersect({&ray, 1}, {&hit, 1});
    EXPECT_FALSE(hit.met);
}

} // namespace
} // namespace ssrlab
