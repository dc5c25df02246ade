#include "truth/scene_surface.h"

#include "core/pixel_index.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

const Vertex& corner(const Scene& scene, const SurfacePoint& point, int i)
{
    return scene.vertices[scene.indices[scene.draws[point.draw].first_index + 3 * point.triangle + uint32_t(i)]];
}

template <typename T> T interpolate(const Scene& scene, const SurfacePoint& point, T Vertex::*attribute)
{
    const auto u = float(point.barycentric.x), v = float(point.barycentric.y);
    return corner(scene, point, 0).*attribute * (1 - u - v) + corner(scene, point, 1).*attribute * u +
           corner(scene, point, 2).*attribute * v;
}

int wrap(int i, int size, Wrap mode)
{
    if (mode == Wrap::clamp_to_edge) return std::clamp(i, 0, size - 1);
    const int period = mode == Wrap::repeat ? size : 2 * size;
    const int inside = (i % period + period) % period;
    return inside < size ? inside : period - 1 - inside;
}

float srgb_to_linear(float value)
{
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

std::array<float, 256> linear_bytes()
{
    std::array<float, 256> values{};
    for (size_t i = 0; i < values.size(); ++i) values[i] = srgb_to_linear(float(i) / 255.0F);
    return values;
}

glm::vec4 texel(const Texture& texture, int x, int y)
{
    const int      column = wrap(x, texture.size_px.x, texture.wrap_u);
    const int      row    = wrap(y, texture.size_px.y, texture.wrap_v);
    const uint8_t* bytes  = &texture.rgba[4 * pixel_index({column, row}, texture.size_px)];
    if (!texture.srgb) return glm::vec4(bytes[0], bytes[1], bytes[2], bytes[3]) / 255.0F;
    static const std::array<float, 256> linear = linear_bytes();
    return {linear[bytes[0]], linear[bytes[1]], linear[bytes[2]], float(bytes[3]) / 255.0F};
}

glm::vec4 sample(const Scene& scene, const TextureUse& use, const SurfacePoint& point)
{
    if (use.texture < 0 || size_t(use.texture) >= scene.textures.size()) return glm::vec4(1);
    const Texture& texture = scene.textures[size_t(use.texture)];
    if (texture.rgba.empty()) return glm::vec4(1);
    const glm::vec2 uv    = interpolate(scene, point, use.uv_set == 1 ? &Vertex::uv1 : &Vertex::uv0);
    const glm::vec2 at_px = glm::vec2(use.uv_transform * glm::vec3(uv, 1)) * glm::vec2(texture.size_px);
    // Beyond this, int and float lose the texel anyway.
    if (!(std::abs(at_px.x) < 1e8F && std::abs(at_px.y) < 1e8F)) return texel(texture, 0, 0);
    if (texture.nearest) return texel(texture, int(std::floor(at_px.x)), int(std::floor(at_px.y)));
    const glm::vec2 low  = glm::floor(at_px - 0.5F);
    const glm::vec2 part = at_px - 0.5F - low;
    const int       x = int(low.x), y = int(low.y);
    return glm::mix(glm::mix(texel(texture, x, y), texel(texture, x + 1, y), part.x),
                    glm::mix(texel(texture, x, y + 1), texel(texture, x + 1, y + 1), part.x), part.y);
}

/// The interpolated normal, turned by the normal map.
glm::dvec3 mapped_normal_ws(const Scene& scene, const SurfacePoint& point)
{
    const Material&  material = scene.materials[scene.draws[point.draw].material];
    const glm::dvec3 normal   = shading_normal_ws(scene, point);
    const glm::dvec3 along_u  = glm::dvec3(glm::vec3(interpolate(scene, point, &Vertex::tangent_ws)));
    const glm::dvec3 across   = along_u - normal * glm::dot(normal, along_u);
    if (material.normal_texture.texture < 0 || normal == glm::dvec3(0) || !(glm::length(across) > 0)) return normal;
    const glm::dvec3 tangent   = glm::normalize(across);
    const glm::dvec3 bitangent = glm::cross(normal, tangent) * double(corner(scene, point, 0).tangent_ws.w);
    const glm::dvec3 mapped    = 2.0 * glm::dvec3(glm::vec3(sample(scene, material.normal_texture, point))) - 1.0;
    const double     scale     = double(material.normal_scale);
    const glm::dvec3 sum       = scale * (tangent * mapped.x + bitangent * mapped.y) + normal * mapped.z;
    return glm::length(sum) > 0 ? glm::normalize(sum) : normal;
}

} // namespace

glm::dvec3 corner_ws(const Scene& scene, const SurfacePoint& point, int i)
{
    return glm::dvec3(corner(scene, point, i).position_ws);
}

glm::vec4 surface_colour(const Scene& scene, const SurfacePoint& point)
{
    const Material& material = scene.materials[scene.draws[point.draw].material];
    return material.base_colour * interpolate(scene, point, &Vertex::colour) *
           sample(scene, material.base_colour_texture, point);
}

glm::dvec3 shading_normal_ws(const Scene& scene, const SurfacePoint& point)
{
    const glm::dvec3 sum    = glm::dvec3(interpolate(scene, point, &Vertex::normal_ws));
    const double     length = glm::length(sum);
    return std::isfinite(length) && length > 0 ? sum / length : glm::dvec3(0);
}

SurfaceMaterial surface_material(const Scene& scene, const SurfacePoint& point)
{
    const Material& material = scene.materials[scene.draws[point.draw].material];
    SurfaceMaterial result;
    const glm::vec4 gloss = sample(scene, material.metallic_roughness_texture, point);
    result.base_colour    = glm::vec3(surface_colour(scene, point));
    result.metallic       = material.metallic * gloss.b;
    result.roughness      = std::clamp(material.roughness * gloss.g, 0.0F, 1.0F);
    result.dielectric_f0  = material.dielectric_f0;
    result.emissive       = material.emissive * glm::vec3(sample(scene, material.emissive_texture, point));
    result.emissive       = glm::min(result.emissive, largest_radiance);
    result.bounced        = interpolate(scene, point, &Vertex::bounced);
    result.normal_ws      = mapped_normal_ws(scene, point);
    return result;
}

} // namespace ssrlab
