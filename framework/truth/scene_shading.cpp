#include "truth/ggx_lobe.h"
#include "truth/scene_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace ssrlab {
namespace {

constexpr double nearest_light_m = 1e-6; // a light has no size, and lights nothing in its own place

/// Light arriving at a point from one light, unshadowed.
struct Arriving {
    glm::vec3  irradiance{0};  // on a surface that faces the light
    glm::dvec3 to_light_ws{0}; // unit
    double     distance_m = std::numeric_limits<double>::infinity();
};

/// Range and cone as glTF's KHR_lights_punctual defines them.
Arriving arriving_light(const Light& light, glm::dvec3 point_ws)
{
    if (light.type == LightType::directional) {
        return {light.intensity, -glm::normalize(glm::dvec3(light.direction_ws)),
                std::numeric_limits<double>::infinity()};
    }
    const glm::dvec3 offset     = glm::dvec3(light.position_ws) - point_ws;
    const double     distance_m = glm::length(offset);
    if (!(distance_m > nearest_light_m)) return {};
    Arriving result{light.intensity, offset / distance_m, distance_m};
    double   scale = 1 / (distance_m * distance_m);
    if (light.range_m > 0) scale *= std::clamp(1 - std::pow(distance_m / double(light.range_m), 4.0), 0.0, 1.0);
    if (light.type == LightType::spot) {
        const double cos_outer = std::cos(double(light.outer_angle_rad));
        const double cos_inner = std::cos(double(light.inner_angle_rad));
        const double cos_angle = glm::dot(-result.to_light_ws, glm::normalize(glm::dvec3(light.direction_ws)));
        const double cone      = std::clamp((cos_angle - cos_outer) / std::max(cos_inner - cos_outer, 1e-3), 0.0, 1.0);
        scale *= cone * cone;
    }
    result.irradiance *= float(scale);
    return result;
}

bool in_shadow(const SceneBvh& bvh, glm::dvec3 point_ws, const Arriving& light, double offset_m)
{
    const SceneRay         ray{point_ws, light.to_light_ws, offset_m, light.distance_m - offset_m};
    std::array<uint8_t, 1> blocked{};
    bvh.occluded({&ray, 1}, Sides::both, blocked);
    return blocked[0] != 0;
}

/// What every light that reaches the point gives.
template <typename Add>
void for_each_light(const SceneBvh& bvh, const Scene& scene, const LitPoint& lit, const Add& add)
{
    for (const Light& light : scene.lights) {
        const Arriving arriving = arriving_light(light, lit.point_ws);
        const double   cosine   = glm::dot(lit.normal_ws, arriving.to_light_ws);
        if (!(cosine > 0) || arriving.irradiance == glm::vec3(0)) continue;
        add(arriving, float(cosine),
            [&] { return light.casts_shadow && in_shadow(bvh, lit.lifted_ws, arriving, lit.offset_m); });
    }
}

/// Where a ray in this direction met a surface.
LitPoint met_point(const SceneHit& hit, glm::dvec3 point_ws, glm::dvec3 direction_ws, glm::dvec3 normal_ws)
{
    const double side     = glm::dot(hit.normal_ws, direction_ws) > 0 ? -1 : 1;
    const double offset_m = self_hit_share * std::max(1.0, hit.t);
    return {point_ws, point_ws + offset_m * side * glm::normalize(hit.normal_ws), normal_ws, offset_m};
}

/// GGX, Walter et al. 2007, times the cosine to the light.
glm::dvec3 ggx(glm::dvec3 normal, glm::dvec3 to_eye, glm::dvec3 to_light, glm::dvec3 f0, double roughness)
{
    const glm::dvec3 half = glm::normalize(to_eye + to_light);
    const double     n_v = std::max(glm::dot(normal, to_eye), 1e-4), n_l = glm::dot(normal, to_light),
                 n_h = std::max(glm::dot(normal, half), 0.0), alpha2 = std::pow(std::max(roughness, 0.05), 4);
    const auto   root   = [&](double cosine) { return std::sqrt(alpha2 + (1 - alpha2) * cosine * cosine); };
    const double spread = n_h * n_h * (alpha2 - 1) + 1, visibility = 0.5 / (n_l * root(n_v) + n_v * root(n_l));
    return fresnel(f0, glm::dot(to_eye, half)) * (alpha2 / (std::numbers::pi * spread * spread) * visibility * n_l);
}

} // namespace

glm::dvec3 seen_normal_ws(const SurfaceMaterial& material, const SceneHit& hit, glm::dvec3 direction_ws)
{
    // The interpolated normal follows the triangle's.
    const double side = glm::dot(hit.normal_ws, direction_ws) > 0 ? -1 : 1;
    return material.normal_ws == glm::dvec3(0) ? side * glm::normalize(hit.normal_ws) : side * material.normal_ws;
}

glm::vec3 shade_highlight(const SceneBvh& bvh, const Scene& scene, const SceneHit& hit, glm::dvec3 point_ws,
                          glm::dvec3 direction_ws, double roughness)
{
    constexpr double      negligible = 5e-4; // not worth a shadow ray
    const SurfaceMaterial material   = surface_material(scene, hit.surface);
    const glm::dvec3      normal_ws  = seen_normal_ws(material, hit, direction_ws);
    const glm::dvec3      f0 = f0_of(material.base_colour, double(material.metallic), double(material.dielectric_f0));
    glm::vec3             sum(0);
    for_each_light(bvh, scene, met_point(hit, point_ws, direction_ws, normal_ws),
                   [&](const Arriving& arriving, float /*cosine*/, const auto& shadowed) {
                       const glm::dvec3 light =
                           glm::dvec3(arriving.irradiance) *
                           ggx(normal_ws, -glm::normalize(direction_ws), arriving.to_light_ws, f0, roughness);
                       if (std::max({light.x, light.y, light.z}) > negligible && !shadowed()) sum += glm::vec3(light);
                   });
    return glm::min(sum, largest_radiance);
}

glm::vec3 direct_irradiance(const SceneBvh& bvh, const Scene& scene, const LitPoint& lit)
{
    glm::vec3 irradiance(0);
    for_each_light(bvh, scene, lit, [&](const Arriving& arriving, float cosine, const auto& shadowed) {
        if (!shadowed()) irradiance += arriving.irradiance * cosine;
    });
    return irradiance;
}

glm::vec3 shade_point(const SceneBvh& bvh, const Scene& scene, const SceneHit& hit, glm::dvec3 point_ws,
                      glm::dvec3 direction_ws)
{
    const SurfaceMaterial material   = surface_material(scene, hit.surface);
    const glm::dvec3      normal_ws  = seen_normal_ws(material, hit, direction_ws);
    const glm::vec3       irradiance = direct_irradiance(bvh, scene, met_point(hit, point_ws, direction_ws, normal_ws));
    const glm::vec3       albedo     = material.base_colour * (1 - material.metallic);
    const glm::vec3       direct     = albedo * (1 / std::numbers::pi_v<float>)*irradiance;
    const glm::vec3       around     = (scene.ambient + material.bounced) * material.base_colour;
    return glm::min(direct + around + material.emissive, largest_radiance);
}

} // namespace ssrlab
