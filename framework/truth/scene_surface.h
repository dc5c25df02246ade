// The material at a point of a scene's triangle: interpolated vertices, textures at their finest level.
#pragma once

#include "scene/scene.h"

namespace ssrlab {

/// A point on triangle `triangle` of draw `draw`; barycentric weights of the second and third corner.
struct SurfacePoint {
    uint32_t   draw     = 0;
    uint32_t   triangle = 0;
    glm::dvec2 barycentric{0};
};

struct SurfaceMaterial {
    glm::vec3  base_colour{1}; // linear
    float      metallic      = 0;
    float      roughness     = 1;
    float      dielectric_f0 = 0; // reflectance at normal incidence of what is not metal
    glm::vec3  emissive{0};       // linear radiance
    glm::vec3  bounced{0};        // Vertex::bounced
    glm::dvec3 normal_ws{0};      // shading_normal_ws(), turned by the normal map
};

glm::dvec3 corner_ws(const Scene& scene, const SurfacePoint& point, int corner);

/// Returns the linear base colour with its alpha, which an alpha mask compares with its cutoff.
glm::vec4 surface_colour(const Scene& scene, const SurfacePoint& point);

/// Returns the interpolated normal without normal map: a unit vector, or 0 if the mesh has none.
glm::dvec3 shading_normal_ws(const Scene& scene, const SurfacePoint& point);

SurfaceMaterial surface_material(const Scene& scene, const SurfacePoint& point);

} // namespace ssrlab
