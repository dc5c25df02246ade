// Scenes whose gloss or alpha comes from textures; metres, y up, ground at y = -1.
//
//   puddle          ground 13 x 13 m, centre (0, -4.8). A texel of it is wet where it lies within R (1 + 0.28 sin(3a + 0.4) + 0.13
//                   sin(7a + 1.3) + 0.06 sin(13a + 2)) of a puddle's centre (x, z), a = its angle there; (centre, R) = ((0.3, -3.9), 1.9),
//                   ((-3.1, -2.2), 0.75), ((3.4, -5.6), 0.95). Wet: roughness 0.03, metallic 1; dry: 0.6 to 0.7, metallic 0.4.
//   everything      floor tiles of roughness 0.04 and 0.4, two facing mirrors, a smooth and a rough metal ball, a fence with holes.
#include "scene/builtin_parts.h"
#include "scene/shapes.h"

#include <array>
#include <cmath>

namespace ssrlab {
namespace {

/// `texel(x, y)` gives bytes; texels keep hard borders.
template <typename Texel> int add_texture(Model& model, int side_px, bool srgb, const Texel& texel)
{
    Texture texture;
    texture.size_px = {side_px, side_px};
    texture.srgb    = srgb;
    texture.nearest = true;
    texture.mipmaps = false;
    for (int y = 0; y < side_px; ++y)
        for (int x = 0; x < side_px; ++x)
            for (const uint8_t byte : texel(x, y)) texture.rgba.push_back(byte);
    model.textures.push_back(std::move(texture));
    return static_cast<int>(model.textures.size() - 1);
}

using Bytes = std::array<uint8_t, 4>;

/// Green is roughness, blue is metallic.
Bytes gloss_bytes(double roughness, double metallic)
{
    return {0, static_cast<uint8_t>(std::lround(255 * roughness)), static_cast<uint8_t>(std::lround(255 * metallic)),
            255};
}

struct PuddleShape {
    glm::dvec2 centre_xz;
    double     radius_m;
};

bool is_wet(glm::dvec2 point_xz)
{
    constexpr PuddleShape puddles[] = {{{0.3, -3.9}, 1.9}, {{-3.1, -2.2}, 0.75}, {{3.4, -5.6}, 0.95}};
    for (const PuddleShape& puddle : puddles) {
        const glm::dvec2 offset = point_xz - puddle.centre_xz;
        const double     a      = std::atan2(offset.y, offset.x);
        const double     edge =
            1 + 0.28 * std::sin(3 * a + 0.4) + 0.13 * std::sin(7 * a + 1.3) + 0.06 * std::sin(13 * a + 2);
        if (glm::length(offset) < puddle.radius_m * edge) return true;
    }
    return false;
}

/// 0 to 1, without order.
double speckle(int x, int y)
{
    uint32_t hash = static_cast<uint32_t>(x) * 0x9E3779B1U ^ static_cast<uint32_t>(y) * 0x85EBCA77U;
    hash          = (hash ^ (hash >> 15U)) * 0xC2B2AE3DU;
    return (hash >> 24U) / 255.0;
}

/// The same in smooth patches of `side` texels.
double patches(int x, int y, int side)
{
    const int    column = x / side, row = y / side;
    const double u = (x % side + 0.5) / side, v = (y % side + 0.5) / side;
    return glm::mix(glm::mix(speckle(column, row), speckle(column + 1, row), u),
                    glm::mix(speckle(column, row + 1), speckle(column + 1, row + 1), u), v);
}

void add_puddle_ground(Model& model)
{
    constexpr int    side_px = 1024;
    constexpr double side_m = 13, left_m = -6.5, far_m = -11.3;
    const auto       wet = [&](int x, int y) {
        return is_wet(glm::dvec2(left_m, far_m) + (glm::dvec2(x, y) + 0.5) * (side_m / side_px));
    };
    const int      gloss  = add_texture(model, side_px, false, [&](int x, int y) {
        return wet(x, y) ? gloss_bytes(0.03, 1) : gloss_bytes(0.6 + 0.1 * patches(x, y, 16), 0.4);
    });
    const int      colour = add_texture(model, side_px, true, [&](int x, int y) -> Bytes {
        if (wet(x, y)) return {225, 230, 235, 255};
        const double grain = 0.45 * patches(x, y, 5) + 0.55 * patches(x, y, 37);
        const auto   shade = static_cast<uint8_t>(105 + std::lround(60 * grain));
        return {shade, static_cast<uint8_t>(shade - 10), static_cast<uint8_t>(shade - 24), 255};
    });
    const uint32_t ground = add_metal(model, "ground", glm::vec3(1), 1);
    model.materials[ground].metallic_roughness_texture.texture = gloss;
    model.materials[ground].base_colour_texture.texture        = colour;
    Mesh mesh = make_quad({left_m, floor_y_m, far_m + side_m}, {side_m, 0, 0}, {0, 0, -side_m});
    multiply_uv(mesh, 1 / side_m);
    add(model, "ground", ground, std::move(mesh));
}

void add_fence(Model& model)
{
    model.materials.push_back(make_material("fence", glm::vec3(1), 0, 0.7F));
    Material& fence                   = model.materials.back();
    fence.alpha_mask                  = true;
    fence.double_sided                = true;
    fence.base_colour_texture.texture = add_texture(model, 32, true, [](int x, int y) -> Bytes {
        const bool wire = (x + y) % 32 < 5 || (x - y + 32) % 32 < 5;
        return {90, 150, 110, static_cast<uint8_t>(wire ? 255 : 0)};
    });
    Mesh mesh                         = make_quad({-1.37, floor_y_m, -4.43}, {2.71, 0, 0.37}, {0, 0.83, 0});
    multiply_uv(mesh, 3);
    add(model, "fence", static_cast<uint32_t>(model.materials.size() - 1), std::move(mesh));
}

} // namespace

Model puddle()
{
    Model model = start_scene(
        {look("default", {0.07, 0.63, 1.3}, {0.13, -0.71, -3.7}, 60, "hard borders between smooth and rough"),
         look("low", {-0.21, -0.63, 0.7}, {0.03, -0.67, -4.1}, 55, "grazing: puddles are a few pixels high"),
         look("border", {0.6, -0.23, -1.1}, {0.5, -1, -2.6}, 50, "close to a puddle's border")});
    add_sky(model);
    add_puddle_ground(model);
    add_wall(model, 6.5, -10.3, 0.9);
    add_things(model, -7.1);
    return model;
}

Model everything()
{
    Model model =
        start_scene({look("default", {0.17, 0.53, 1.9}, {-0.03, -0.37, -3.7}, 60, "needs every effect"),
                     look("low", {0.33, -0.57, 1.1}, {0.07, -0.51, -4.3}, 60, "grazing, through the fence"),
                     look("above", {0.23, 2.6, 0.2}, {0.11, -1, -4.3}, 60, "from above: rays go to the sky")});
    add_sky(model);
    Mesh           floor = make_quad({-7.3, floor_y_m, 3.1}, {14.6, 0, 0}, {0, 0, -14.6});
    const uint32_t tiles = add_metal(model, "tiles", {0.72F, 0.74F, 0.77F}, 1);
    model.materials[tiles].metallic_roughness_texture.texture = add_texture(
        model, 2, false, [](int x, int y) { return x == y ? gloss_bytes(0.04, 1) : gloss_bytes(0.4, 0.9); });
    multiply_uv(floor, 0.61);
    add(model, "floor", tiles, std::move(floor));
    add_wall(model, 7.3, -11.3, 0.7);
    add_things(model, -7.1);
    add_facing_mirrors(model, -2.3, -6.7, 1.7);
    add_fence(model);
    add(model, "smooth ball", add_metal(model, "chrome", glm::vec3(0.95F), 0),
        make_sphere({-0.79, -0.47, -3.1}, 0.53, 256, 128));
    add(model, "rough ball", add_metal(model, "brass", {0.9F, 0.7F, 0.35F}, 0.35F),
        make_sphere({0.83, -0.57, -2.7}, 0.43, 256, 128));
    return model;
}

} // namespace ssrlab
