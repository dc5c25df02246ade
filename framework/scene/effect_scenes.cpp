// Scenes that call for effects. Metres, y up, ground at y = -1. Odd numbers throughout: with simple ratios many rays meet corners and
// faces exactly, where even real arithmetic ties.
//
//   gloss_steps     strip k = 0 .. 7: roughness k / 10, x from -4.12 + 1.03 k, 1.03 m wide; behind its middle, at z = -6.15, a glowing
//                   post 3.3 m high. From d m before the post its foot is d m away and its top sqrt(d^2 + 3.3^2): blur grows upwards.
//   facing_mirrors  left mirror x = -2.13, right mirror turned by 2 degrees about (2.31, -8): the k-th image of a point between them
//                   is about 4.4 k m away to the side.
//   hidden_shelf    seen from (0.03, 0.02, 0.04), the board at z = -4.6, y = 0.13 to 0.61 covers y = 0.194 to 0.953 of the wall at
//                   z = -7.3: the shelf. Mirrored, the camera is at y = -2.02 and sees the wall below y = 1.38 under the board.
//   small_mirror    a plate of 4.2 x 2.5 m: 10 % of the default view's pixels.   matte: the same without the plate.
#include "scene/builtin_parts.h"
#include "scene/shapes.h"

namespace ssrlab {
namespace {

/// Ground that does not reflect, with tiles of one metre.
void add_matte_floor(Model& model, double half_width_m, double near_z_m, double far_z_m)
{
    Mesh mesh = make_quad({-half_width_m, floor_y_m, near_z_m}, {2 * half_width_m, 0, 0}, {0, 0, far_z_m - near_z_m});
    multiply_uv(mesh, 0.5);
    add(model, "floor", add_checker(model, "floor", {0.62F, 0.6F, 0.55F}, {0.45F, 0.43F, 0.4F}), std::move(mesh));
}

void add_plain_room(Model& model)
{
    add_matte_floor(model, 21, 5, -9.7);
    add_wall(model, 21, -9.7, 5.3);
    add_things(model, -5.3);
}

std::vector<Camera> room_cameras()
{
    return {look("default", {0.17, 0.47, 1.1}, {-0.36, -0.35, -3.9}, 60, "few pixels reflect, in one place"),
            look("low", {0.13, -0.67, 0.3}, {0.17, -0.71, -4.1}, 60, "low: what reflects is a thin strip"),
            look("above", {0.19, 2.3, -0.7}, {0.07, -1, -3.3}, 60, "from above: rays leave the screen at its top")};
}

} // namespace

Model gloss_steps()
{
    Model model = start_scene(
        {look("default", {0.05, 0.87, 2.9}, {0.02, -0.43, -4.1}, 50, "reflections that widen with distance"),
         look("low", {0.31, -0.43, 1.7}, {0.17, -0.47, -4.3}, 60, "grazing: long streaks"),
         look("smooth", {-2.63, 0.21, -1.3}, {-2.57, -0.83, -4.9}, 60, "the sharpest four strips, close")});
    model.background              = glm::vec3(0.05F, 0.06F, 0.08F);
    model.ambient                 = model.background;
    constexpr glm::vec3 colours[] = {{1, 0.15F, 0.1F},   {1, 0.55F, 0.1F}, {0.95F, 0.9F, 0.15F}, {0.3F, 0.9F, 0.2F},
                                     {0.1F, 0.8F, 0.8F}, {0.2F, 0.35F, 1}, {0.65F, 0.25F, 1},    {1, 0.3F, 0.7F}};
    for (int k = 0; k < 8; ++k) {
        const double   left_m = -4.12 + 1.03 * k, middle_m = left_m + 0.515;
        const uint32_t strip = add_metal(model, "strip", glm::vec3(0.9F), 0.1F * static_cast<float>(k));
        add(model, "strip", strip, make_quad({left_m, floor_y_m, 1.7}, {1.03, 0, 0}, {0, 0, -9.1}));
        const uint32_t post            = add_material(model, "post", glm::vec3(0.1F));
        model.materials[post].emissive = 1.3F * colours[k];
        add(model, "post", post, make_box({middle_m - 0.17, floor_y_m, -6.32}, {middle_m + 0.17, 2.3, -6.15}));
    }
    const uint32_t wall = add_material(model, "wall", glm::vec3(0.25F));
    add(model, "wall", wall, make_quad({-4.12, floor_y_m, -7.4}, {8.24, 0, 0}, {0, 5.1, 0}));
    return model;
}

Model facing_mirrors()
{
    Model model =
        start_scene({look("default", {0.06, 0.27, 1.7}, {-0.33, -0.07, -3.7}, 65, "mirrors that reflect mirrors"),
                     look("left", {1.47, 0.31, -0.9}, {-2.13, 0.03, -5.3}, 65, "into one mirror, at an angle"),
                     look("above", {0.23, 2.7, 0.3}, {0.07, -0.6, -6.1}, 60, "from above, over both mirrors")});
    add_matte_floor(model, 9.3, 5, -17.3);
    add_wall(model, 9.3, -17.3, 5.7);
    add_facing_mirrors(model, 0.4, -16.4, 2.9);
    const uint32_t ball = add_checker(model, "ball", {0.9F, 0.75F, 0.2F}, {0.6F, 0.15F, 0.2F});
    const uint32_t box  = add_material(model, "box", {0.15F, 0.35F, 0.75F});
    add(model, "ball", ball, make_sphere({0.23, -0.31, -5.3}, 0.69, 256, 128));
    add(model, "box", box, make_box({-1.11, floor_y_m, -8.7}, {-0.33, 0.37, -7.9}));
    add(model, "low box", box, make_box({0.71, floor_y_m, -3.1}, {1.23, -0.61, -2.6}));
    return model;
}

Model hidden_shelf()
{
    Model model =
        start_scene({look("default", {0.03, 0.02, 0.04}, {0.09, -0.47, -4.1}, 70, "the mirror shows what is hidden"),
                     look("left", {-1.7, 0.11, 0.3}, {-0.1, -0.41, -4.7}, 70, "from the side: half of the shelf"),
                     look("low", {0.13, -0.53, 0.2}, {0.17, -0.49, -4.1}, 70, "grazing: the board's long shadow")});
    model.materials.push_back(make_material("mirror", glm::vec3(0.95F), 1, 0));
    add_floor(model, 11, 5, -7.3);
    add_wall(model, 11, -7.3, 4.1);
    const uint32_t stripe = add_checker(model, "stripe", {0.95F, 0.25F, 0.75F}, {0.95F, 0.85F, 0.1F});
    Mesh           band   = make_quad({-3.47, 0.2, -7.28}, {6.94, 0, 0}, {0, 0.745, 0});
    multiply_uv(band, 1.3);
    add(model, "stripe", stripe, std::move(band));
    const uint32_t can = add_material(model, "can", {0.1F, 0.6F, 0.85F});
    Mesh           cans;
    for (int k = -4; k <= 4; ++k) append(cans, make_cylinder({0.71 * k, 0.24, -7.03}, 0.13, 0.43, 32));
    add(model, "cans", can, std::move(cans));
    add(model, "board", add_material(model, "board", {0.3F, 0.22F, 0.17F}),
        make_box({-2.3, 0.13, -4.67}, {2.3, 0.61, -4.6}));
    return model;
}

Model small_mirror()
{
    Model model = start_scene(room_cameras());
    add_plain_room(model);
    add(model, "plate", add_metal(model, "mirror", glm::vec3(0.95F), 0),
        make_box({-2.11, floor_y_m, -4.2}, {2.07, -0.96, -1.7}));
    return model;
}

Model matte()
{
    Model model = start_scene(room_cameras());
    add_plain_room(model);
    return model;
}

} // namespace ssrlab
