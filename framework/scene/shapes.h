// Meshes that need no file. All face outwards and have analytic normals; texture coordinates are in metres.
#pragma once

#include "scene/model.h"

namespace ssrlab {

/// `edge_u` x `edge_v` is the front.
Mesh make_quad(glm::dvec3 corner_ws, glm::dvec3 edge_u_ws, glm::dvec3 edge_v_ws);
Mesh make_box(glm::dvec3 min_ws, glm::dvec3 max_ws);
Mesh make_sphere(glm::dvec3 centre_ws, double radius_m, int slices, int stacks);
/// Upright, with caps.
Mesh make_cylinder(glm::dvec3 base_ws, double radius_m, double height_m, int slices);

/// The Utah teapot, 3.15 units high, spout along +x, y up, standing on y = 0.
/// Every one of its patches becomes 2 * patch_steps^2 triangles.
Mesh make_teapot(int patch_steps);

void multiply_uv(Mesh& mesh, double factor);

/// Two by two squares of two sRGB colours; one repeat is 1 in u and v.
Texture make_checker_texture(glm::vec3 colour_a, glm::vec3 colour_b);
/// A normal map: one wave along u and one along v, each with a largest slope of 1.
Texture  make_wave_normals();
Material make_material(const std::string& name, glm::vec3 base_colour, float metallic, float roughness);

/// Reflectance at normal incidence of a dielectric, from its refractive index.
float ior_to_f0(double ior);

} // namespace ssrlab
