// The environment map on the device: the same lookup as in C++, and what pixels without a surface show.
#include "core/files.h"
#include "core/pixel_index.h"
#include "frame/gpu_scene.h"
#include "gpu/compute.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

/// Random texels: a lookup that is a hundredth of a texel off shows.
Scene with_random_sky(glm::ivec2 size_px)
{
    Scene                                 scene = load_scene("builtin:void");
    std::mt19937                          random(5);
    std::uniform_real_distribution<float> value(0, 4);
    scene.environment.size_px = size_px;
    for (int i = 0; i < size_px.x * size_px.y; ++i)
        scene.environment.radiance.emplace_back(value(random), value(random), value(random));
    return scene;
}

std::vector<glm::vec3> many_directions()
{
    // Axes and poles first, and both sides of the seam behind.
    std::vector<glm::vec3>          directions{{0, 0, -1}, {1, 0, 0},     {-1, 0, 0},     {0, 1, 0},     {0, -1, 0},
                                      {0, 0, 1},  {1e-6F, 0, 1}, {-1e-6F, 0, 1}, {1e-6F, 1, 0}, {0, -1, 1e-6F}};
    std::mt19937                    random(7);
    std::normal_distribution<float> value;
    while (directions.size() < 4096) directions.emplace_back(value(random), value(random), value(random));
    return directions;
}

std::vector<glm::vec3> look_up_on_device(const Scene& scene, const std::vector<glm::vec3>& directions)
{
    const GpuScenePtr uploaded = upload_scene(device(), scene);
    const Buffer      asked    = make_buffer_with<glm::vec3>(device(), directions);
    const Buffer      answers  = make_buffer(device(), directions.size() * sizeof(glm::vec3));
    const ComputePass pass     = make_compute_pass(
            device(), compile_shader(device(), {.file = data_root() / "tests/gpu/environment.comp"}),
            {{"environment_map", uploaded->environment_map}, {"Directions", asked}, {"Radiances", answers}});
    submit(device(), [&](const Commands& commands) {
        dispatch(commands, pass, {static_cast<uint32_t>(directions.size() + 63) / 64, 1, 1});
        barrier(commands);
    });
    return download_as<glm::vec3>(device(), answers, directions.size());
}

TEST(Environment, IsLookedUpAsInCpp)
{
    const auto directions = many_directions();
    for (const glm::ivec2& size : {glm::ivec2(64, 32), glm::ivec2(2, 1), glm::ivec2(1024, 512)}) {
        const Scene scene = with_random_sky(size);
        const auto  found = look_up_on_device(scene, directions);
        // The device's arctangent may be off by about 3e-6 of the circle; texels differ by up to 4.
        const float tolerance = 4 * 2 * 3e-6F * static_cast<float>(size.x) + 1e-5F;
        for (size_t i = 0; i < directions.size(); ++i)
            ASSERT_LE(glm::length(found[i] - sky_radiance(scene, glm::dvec3(directions[i]))), tolerance)
                << size.x << " wide, direction " << directions[i].x << ' ' << directions[i].y << ' ' << directions[i].z;
    }
}

TEST(Environment, WithoutAMapIsTheBackgroundToTheLastBit)
{
    Scene scene      = load_scene("builtin:void");
    scene.background = {0.1F, 0.7F, 1.3F};
    for (const glm::vec3& radiance : look_up_on_device(scene, many_directions())) ASSERT_EQ(radiance, scene.background);
}

Camera tilted_camera(Projection projection)
{
    Camera camera;
    camera.projection  = projection;
    camera.position_ws = {1, 2, 3};
    camera.target_ws   = {-2, 3.1, 4.5};
    camera.up_ws       = {0.1, 1, 0};
    camera.fov_y_deg   = 80;
    camera.shift_px    = {3.3, -1.7};
    return camera;
}

TEST(Environment, BackgroundPixelsShowItAlongTheirViewRay)
{
    const Scene scene = with_random_sky({64, 32});
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        const Picture    picture       = make_picture(scene, tilted_camera(projection), {97, 61});
        const glm::dmat3 view_to_world = glm::inverse(glm::dmat3(picture.view.world_to_view));
        for (const auto [i, x, y] : pixels_of({97, 61})) {
            const glm::dvec2 offset = (glm::dvec2(x, y) + 0.5 - picture.view.centre_px) / picture.view.focal_px;
            const glm::dvec3 ray_vs =
                projection == Projection::orthographic ? glm::dvec3(0, 0, -1) : glm::dvec3(offset.x, -offset.y, -1);
            const glm::vec3 expected = sky_radiance(scene, view_to_world * ray_vs);
            const glm::vec3 found    = picture.image.radiance[pixel_index({x, y}, picture.image.view.size_px)];
            // Half precision keeps 11 bits.
            ASSERT_LE(glm::length(found - expected), 5e-4F * glm::length(expected) + 2e-3F) << x << ", " << y;
        }
    }
}

TEST(Environment, SurfacesKeepTheirOwnColour)
{
    Scene         scene   = load_scene("builtin:sphere_over_mirror");
    const Picture without = make_picture(scene, find_camera(scene, "default"), {97, 61});
    scene.environment     = with_random_sky({64, 32}).environment;
    const Picture with    = make_picture(scene, find_camera(scene, "default"), {97, 61});
    size_t        sky     = 0;
    for (size_t i = 0; i < with.image.depth.size(); ++i) {
        sky += with.image.depth[i] == 0;
        if (with.image.depth[i] > 0)
            ASSERT_EQ(with.image.radiance[i], without.image.radiance[i]);
        else
            ASSERT_LE(glm::length(without.image.radiance[i] - scene.background), 1e-3F);
    }
    EXPECT_GT(sky, 1000U);
}

} // namespace
} // namespace ssrlab::test
