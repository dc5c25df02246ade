#include "scene/gltf.h"

#include <algorithm>
#include <cmath>

namespace ssrlab::gltf {
namespace {

double to_linear(uint8_t value)
{
    const double share = value / 255.0;
    return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

uint8_t to_byte(double share) { return static_cast<uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }

uint8_t to_srgb(double linear)
{
    return to_byte(linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

/// Linear colour and plain alpha of the texel under texel x, y of a texture of that size.
glm::vec4 texel_under(const Texture& texture, int x, int y, glm::ivec2 size_px)
{
    if (texture.rgba.empty()) return glm::vec4(1);
    const int64_t column = int64_t(x) * texture.size_px.x / size_px.x, row = int64_t(y) * texture.size_px.y / size_px.y;
    const uint8_t* bytes = &texture.rgba[4 * size_t(row * texture.size_px.x + column)];
    return {to_linear(bytes[0]), to_linear(bytes[1]), to_linear(bytes[2]), bytes[3] / 255.0};
}

} // namespace

void set_factors(Material& material, const SpecularGlossiness& factors)
{
    const float f0         = std::max({factors.specular.r, factors.specular.g, factors.specular.b});
    material.metallic      = std::max(0.0F, (f0 - common_dielectric_f0) / (1 - common_dielectric_f0));
    material.dielectric_f0 = std::min(f0, common_dielectric_f0);
    material.roughness     = 1 - factors.glossiness;
    material.base_colour   = {glm::mix(glm::vec3(factors.diffuse), factors.specular, material.metallic),
                              factors.diffuse.a};
}

std::pair<Texture, Texture> bake(const Texture& diffuse, const Texture& gloss, const SpecularGlossiness& factors)
{
    Texture base = gloss, metal = gloss;
    metal.srgb = false;
    Material at;
    for (int y = 0; y < gloss.size_px.y; ++y)
        for (int x = 0; x < gloss.size_px.x; ++x) {
            const glm::vec4 specular = texel_under(gloss, x, y, gloss.size_px);
            set_factors(at, {factors.diffuse * texel_under(diffuse, x, y, gloss.size_px),
                             factors.specular * glm::vec3(specular), factors.glossiness * specular.a});
            const size_t i = 4 * (size_t(y) * size_t(gloss.size_px.x) + size_t(x));
            for (int c = 0; c < 3; ++c) base.rgba[i + size_t(c)] = to_srgb(double(at.base_colour[c]));
            base.rgba[i + 3]  = to_byte(double(at.base_colour.a));
            metal.rgba[i]     = 0;
            metal.rgba[i + 1] = to_byte(double(at.roughness));
            metal.rgba[i + 2] = to_byte(double(at.metallic));
        }
    return {std::move(base), std::move(metal)};
}

} // namespace ssrlab::gltf
