// The list, and its analytic scenes; scenes for effects are in effect_scenes.cpp and textured_scenes.cpp.
// Metres, y up; the level camera stands at the origin and looks along -z with a field of view of 90 degrees.
// Every floor here is a perfect mirror in the plane y = -1, so a reflected ray looks as if it came from (0, -2, 0) upside down.
//
// Closed forms for the level camera, image height H, h = H / 2, c = row or column of the image centre (continuous pixels):
//   floor    row py shows the floor at distance d = h / (py - c); a point at height y_m and distance D is reflected at the
//            row c + h (2 + y_m) / D, and seen itself at row c - h y_m / D. Both lie in the same column.
//   mirror_floor_wall   wall at D = 10: the floor at row py reflects the wall at row 1.1 H - py (H = 64: 70.4 - py).
//   sphere_over_mirror  centre (0, 0, -5), radius 1, touching the floor: its mirror image is the sphere about (0, -2, -5).
//   pole_field          poles of radius 0.02 at x = -6 .. 6 by 0.5, z = -3, -4.5 .. -10.5: each is its own reflection's column.
//   stairs              step k = 0 .. 7: riser at z = -4 - 0.5 k from y = -1 + 0.25 k to -0.75 + 0.25 k.
//   corridor            walls x = -2.07, 2.07, ceiling y = 2.03, end wall z = -40, columns every 3 m at x = -1.6, 1.6. No simple
//                       ratios: with walls at twice the floor's depth every other ray meets its wall exactly on a pixel border.
//   void                nothing at all: every pixel is background.
#include "scene/builtin_scenes.h"

#include "scene/builtin_parts.h"
#include "scene/shapes.h"

#include <array>

namespace ssrlab {
namespace {

Model mirror_floor_wall()
{
    Model model = start_scene();
    add_floor(model, 40, 5, -10);
    add_wall(model, 40, -10, 20);
    return model;
}

Model sphere_over_mirror()
{
    Model          model  = start_scene();
    const uint32_t sphere = add_checker(model, "sphere", {0.9F, 0.75F, 0.2F}, {0.6F, 0.15F, 0.2F});
    add_floor(model, 30, 5, -30);
    add(model, "sphere", sphere, make_sphere({0, 0, -5}, 1, 256, 128));
    return model;
}

Model pole_field()
{
    Model model = start_scene();
    add_floor(model, 40, 5, -14);
    add_wall(model, 40, -14, 6);
    const std::array<uint32_t, 3> colours = {add_material(model, "pole red", {0.8F, 0.15F, 0.1F}),
                                             add_material(model, "pole green", {0.2F, 0.7F, 0.2F}),
                                             add_material(model, "pole white", {0.85F, 0.85F, 0.85F})};
    std::array<Mesh, 3>           poles;
    for (int row = 0; row < 6; ++row)
        for (int column = -12; column <= 12; ++column)
            append(poles[static_cast<size_t>(row + column + 12) % 3],
                   make_cylinder({0.5 * column, floor_y_m, -3 - 1.5 * row}, 0.02, 2.5, 12));
    for (size_t i = 0; i < poles.size(); ++i)
        add(model, model.materials[colours[i]].name.c_str(), colours[i], std::move(poles[i]));
    return model;
}

Model stairs()
{
    Model          model = start_scene();
    const uint32_t dark  = add_material(model, "step dark", {0.35F, 0.25F, 0.2F});
    const uint32_t light = add_material(model, "step light", {0.8F, 0.7F, 0.5F});
    add_floor(model, 30, 5, -12);
    add_wall(model, 30, -12, 6);
    for (int k = 0; k < 8; ++k)
        add(model, "step", k % 2 == 0 ? dark : light,
            make_box({-3, floor_y_m, -4 - 0.5 * (k + 1)}, {3, floor_y_m + 0.25 * (k + 1), -4 - 0.5 * k}));
    return model;
}

Model corridor()
{
    constexpr double side_m = 2.07, height_m = 3.03;
    Model            model = start_scene();
    model.lights.clear();
    for (double z_m : {-3.0, -15.0}) {
        ModelLight lamp;
        lamp.position_ws           = {0, 1.95, z_m};
        lamp.light.type            = LightType::spot;
        lamp.light.direction_ws    = glm::normalize(glm::vec3(0.0F, -1.0F, -0.6F));
        lamp.light.intensity       = glm::vec3(12);
        lamp.light.inner_angle_rad = 0.7F;
        lamp.light.outer_angle_rad = 1.2F;
        model.lights.push_back(lamp);
    }
    const uint32_t wall    = add_checker(model, "wall", {0.75F, 0.6F, 0.45F}, {0.45F, 0.5F, 0.6F});
    const uint32_t ceiling = add_material(model, "ceiling", {0.75F, 0.75F, 0.7F});
    const uint32_t end     = add_material(model, "end wall", {0.8F, 0.2F, 0.15F});
    const uint32_t column  = add_material(model, "column", {0.2F, 0.55F, 0.45F});
    add_floor(model, side_m, 5, -40);
    add(model, "left wall", wall, make_quad({-side_m, floor_y_m, 5}, {0, 0, -45}, {0, height_m, 0}));
    add(model, "right wall", wall, make_quad({side_m, floor_y_m, -40}, {0, 0, 45}, {0, height_m, 0}));
    add(model, "ceiling", ceiling, make_quad({-side_m, floor_y_m + height_m, -40}, {2 * side_m, 0, 0}, {0, 0, 45}));
    add(model, "end wall", end, make_quad({-side_m, floor_y_m, -40}, {2 * side_m, 0, 0}, {0, height_m, 0}));
    add(model, "back wall", end, make_quad({side_m, floor_y_m, 5}, {-2 * side_m, 0, 0}, {0, height_m, 0}));
    Mesh columns;
    for (int k = 0; k < 13; ++k)
        for (double x_m : {-1.6, 1.6})
            append(columns, make_cylinder({x_m, floor_y_m, -2 - 3.0 * k}, 0.15, height_m, 32));
    add(model, "columns", column, std::move(columns));
    return model;
}

/// A box slides and another one turns over a mirror floor; the paths move the camera along its axis, across it, about its own
/// position and around the boxes.
Model moving_boxes()
{
    Model          model = start_scene();
    const uint32_t red   = add_checker(model, "sliding box", {0.85F, 0.25F, 0.15F}, {0.9F, 0.8F, 0.6F});
    const uint32_t green = add_checker(model, "turning box", {0.2F, 0.6F, 0.3F}, {0.85F, 0.9F, 0.7F});
    add_floor(model, 40, 10, -14);
    add_wall(model, 40, -14, 6);
    add(model, "sliding box", red, make_box({-2.5, floor_y_m + 0.5, -6.5}, {-1.5, floor_y_m + 1.5, -5.5}));
    model.meshes.back().motion.move_m = {0.1, 0, 0};
    add(model, "turning box", green, make_box({1, floor_y_m + 0.25, -8.5}, {3, floor_y_m + 2.25, -6.5}));
    model.meshes.back().motion = {.turn_deg = {0, 3, 0}, .pivot_ws = {2, 0, -7.5}};
    const auto at              = [](glm::dvec3 position_ws, glm::dvec3 target_ws) {
        return look("", position_ws, target_ws, 60, "");
    };
    model.paths = {
        {"dolly", {at({0, 0.4, 3}, {0, 0.4, -8}), at({0, 0.4, 0}, {0, 0.4, -8})}, 30},
        {"truck", {at({-1.5, 0.4, 2}, {-1.5, 0, -8}), at({1.5, 0.4, 2}, {1.5, 0, -8})}, 30},
        {"pan", {at({0, 0.4, 2}, {-3, 0, -8}), at({0, 0.4, 2}, {3, 0, -8})}, 30},
        {"orbit",
         {at({-4, 0.6, -1}, {0, -0.4, -7}), at({0, 0.6, 0.5}, {0, -0.4, -7}), at({4, 0.6, -1}, {0, -0.4, -7})},
         30}};
    return model;
}

Model nothing()
{
    Model model;
    model.cameras = {camera("default", {0, 0, 0}, 0, "no surface at all")};
    return model;
}

constexpr std::array<BuiltinScene, 14> scenes = {{
    {"mirror_floor_wall", "Mirror floor before a checkered wall 10 m away.", mirror_floor_wall},
    {"sphere_over_mirror", "A sphere that touches a mirror floor.", sphere_over_mirror},
    {"pole_field", "150 thin poles on a mirror floor before a wall.", pole_field},
    {"stairs", "Eight steps on a mirror floor before a wall.", stairs},
    {"corridor", "A corridor of 45 m with a mirror floor and columns.", corridor},
    {"puddle", "Wet puddles with hard borders in rough ground, under a sky.", puddle},
    {"gloss_steps", "Metal strips of roughness 0, 0.1 … 0.7 before glowing posts.", gloss_steps},
    {"facing_mirrors", "Two mirrors that see each other, with objects between them.", facing_mirrors},
    {"hidden_shelf", "A floating board hides a shelf that the mirror floor shows.", hidden_shelf},
    {"everything", "Rough and smooth metal, facing mirrors, a masked fence and a sky.", everything},
    {"small_mirror", "A small mirror plate among matte things: a tenth of the picture reflects.", small_mirror},
    {"matte", "The same without the mirror: nothing reflects.", matte},
    {"moving_boxes", "A sliding and a turning box over a mirror floor, and four camera paths.", moving_boxes},
    {"void", "No triangles: every pixel is background.", nothing},
}};

} // namespace

std::span<const BuiltinScene> builtin_scenes() { return scenes; }

} // namespace ssrlab
