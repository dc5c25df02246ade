#include "scene/builtin_parts.h"

#include "scene/shapes.h"

#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

constexpr glm::vec3 sun_direction_ws{-0.52F, -0.83F, -0.61F};

} // namespace

Light sun(glm::vec3 direction_ws, float irradiance)
{
    Light light;
    light.direction_ws = glm::normalize(direction_ws);
    light.intensity    = glm::vec3(irradiance);
    return light;
}

Camera camera(const char* name, glm::dvec3 position_ws, double pitch_down_deg, const char* hard_for)
{
    const double pitch = pitch_down_deg * std::numbers::pi / 180;
    Camera       result;
    result.name        = name;
    result.hard_for    = hard_for;
    result.position_ws = position_ws;
    result.target_ws   = position_ws + glm::dvec3(0, -std::sin(pitch), -std::cos(pitch));
    result.fov_y_deg   = 90;
    return result;
}

Model start_scene()
{
    Model model;
    model.materials.push_back(make_material("mirror", glm::vec3(0.95F), 1, 0));
    // The same light from everywhere: where the mirror's ray meets nothing, it looks like the sky.
    model.ambient    = glm::vec3(0.22F, 0.25F, 0.3F);
    model.background = model.ambient;
    model.lights.push_back({sun({-0.5F, -1.0F, -0.7F}, 2.2F), {}});
    model.cameras = {
        camera("default", {0, 0, 0}, 0, "level camera: rays along image columns, many towards the horizon"),
        camera("down", {0, 0, 0}, 25, "pitched down: the floor fills most of the picture"),
        camera("steep", {0, 1.5, -2}, 45,
               "looking down steeply: rays come back towards the camera and leave the screen"),
    };
    return model;
}

void add(Model& model, const char* name, uint32_t material, Mesh mesh)
{
    mesh.name     = name;
    mesh.material = material;
    model.meshes.push_back(std::move(mesh));
}

uint32_t add_material(Model& model, const char* name, glm::vec3 base_colour)
{
    model.materials.push_back(make_material(name, base_colour, 0, 0.7F));
    return static_cast<uint32_t>(model.materials.size() - 1);
}

uint32_t add_checker(Model& model, const char* name, glm::vec3 colour_a, glm::vec3 colour_b)
{
    const uint32_t material                               = add_material(model, name, glm::vec3(1));
    model.materials[material].base_colour_texture.texture = static_cast<int>(model.textures.size());
    model.textures.push_back(make_checker_texture(colour_a, colour_b));
    return material;
}

void add_floor(Model& model, double half_width_m, double near_z_m, double far_z_m)
{
    add(model, "floor", 0,
        make_quad({-half_width_m, floor_y_m, near_z_m}, {2 * half_width_m, 0, 0}, {0, 0, far_z_m - near_z_m}));
}

void add_wall(Model& model, double half_width_m, double z_m, double top_y_m)
{
    const uint32_t checker = add_checker(model, "wall", {0.85F, 0.45F, 0.2F}, {0.25F, 0.45F, 0.75F});
    Mesh wall = make_quad({-half_width_m, floor_y_m, z_m}, {2 * half_width_m, 0, 0}, {0, top_y_m - floor_y_m, 0});
    multiply_uv(wall, 0.5);
    add(model, "wall", checker, std::move(wall));
}

Camera look(const char* name, glm::dvec3 position_ws, glm::dvec3 target_ws, double fov_y_deg, const char* hard_for)
{
    Camera result;
    result.name        = name;
    result.hard_for    = hard_for;
    result.position_ws = position_ws;
    result.target_ws   = target_ws;
    result.fov_y_deg   = fov_y_deg;
    return result;
}

Model start_scene(std::vector<Camera> cameras)
{
    Model model;
    model.ambient    = glm::vec3(0.22F, 0.25F, 0.3F);
    model.background = model.ambient;
    model.lights.push_back({sun(sun_direction_ws, 2.2F), {}});
    model.cameras = std::move(cameras);
    return model;
}

void add_sky(Model& model) { model.environment = make_sky({}, -glm::dvec3(sun_direction_ws)); }

uint32_t add_metal(Model& model, const char* name, glm::vec3 base_colour, float roughness)
{
    model.materials.push_back(make_material(name, base_colour, 1, roughness));
    return static_cast<uint32_t>(model.materials.size() - 1);
}

void add_things(Model& model, double z_m)
{
    const uint32_t red   = add_material(model, "red", {0.8F, 0.13F, 0.1F});
    const uint32_t blue  = add_material(model, "blue", {0.12F, 0.3F, 0.75F});
    const uint32_t white = add_material(model, "white", {0.85F, 0.84F, 0.8F});
    const uint32_t ball  = add_checker(model, "ball", {0.9F, 0.75F, 0.2F}, {0.3F, 0.5F, 0.2F});
    add(model, "red box", red, make_box({-1.93, floor_y_m, z_m - 0.71}, {-0.87, 0.07, z_m + 0.23}));
    add(model, "blue box", blue, make_box({0.31, floor_y_m, z_m - 1.13}, {1.18, 0.73, z_m - 0.36}));
    add(model, "ball", ball, make_sphere({-0.27, -0.53, z_m + 0.41}, 0.47, 128, 64));
    Mesh posts;
    for (const double x_m : {-2.87, 1.79, 2.33, 2.91})
        append(posts, make_cylinder({x_m, floor_y_m, z_m - 0.17 * x_m}, 0.06, 2.17, 24));
    add(model, "posts", white, std::move(posts));
}

void add_facing_mirrors(Model& model, double near_z_m, double far_z_m, double height_m)
{
    const uint32_t mirror   = add_metal(model, "mirror", {0.93F, 0.95F, 0.94F}, 0);
    const double   length_m = near_z_m - far_z_m;
    const double   turn     = std::sin(0.035); // 2 degrees
    add(model, "left mirror", mirror,
        make_quad({-2.13, floor_y_m + 0.11, near_z_m}, {0, 0, -length_m}, {0, height_m, 0}));
    const glm::dvec3 along(length_m * turn, 0, length_m * std::sqrt(1 - turn * turn));
    add(model, "right mirror", mirror,
        make_quad(glm::dvec3(2.31, floor_y_m + 0.11, 0.5 * (near_z_m + far_z_m)) - 0.5 * along, along,
                  {0, height_m, 0}));
}

} // namespace ssrlab
