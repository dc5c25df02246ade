// Small scenes whose reflections have closed forms, seen from the origin along -z.
#pragma once

#include "scene/scene.h"
#include "truth_gbuffers.h"

namespace ssrlab::test {

inline uint32_t add_material(Scene& scene, glm::vec3 base_colour, float metallic)
{
    Material material;
    material.base_colour = glm::vec4(base_colour, 1);
    material.metallic    = metallic;
    scene.materials.push_back(material);
    return uint32_t(scene.materials.size() - 1);
}

inline void add_vertex(Scene& scene, glm::dvec3 position, glm::dvec3 normal, glm::vec2 uv)
{
    scene.vertices.push_back({glm::vec3(position), glm::vec3(normal), glm::vec4(0), uv, uv, glm::vec4(1)});
}

/// Corner, two edges; the front is on the side of edge_u x edge_v.
inline void add_quad(Scene& scene, uint32_t material, glm::dvec3 corner, glm::dvec3 edge_u, glm::dvec3 edge_v)
{
    const auto       first  = uint32_t(scene.vertices.size());
    const glm::dvec3 normal = glm::normalize(glm::cross(edge_u, edge_v));
    add_vertex(scene, corner, normal, {0, 0});
    add_vertex(scene, corner + edge_u, normal, {1, 0});
    add_vertex(scene, corner + edge_u + edge_v, normal, {1, 1});
    add_vertex(scene, corner + edge_v, normal, {0, 1});
    Draw draw;
    draw.first_index = uint32_t(scene.indices.size());
    draw.index_count = 6;
    draw.material    = material;
    scene.draws.push_back(draw);
    for (const uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) scene.indices.push_back(first + i);
}

inline void add_sphere(Scene& scene, uint32_t material, glm::dvec3 centre, double radius, int rings)
{
    const auto first = uint32_t(scene.vertices.size());
    const int  sides = 2 * rings;
    Draw       draw;
    draw.first_index = uint32_t(scene.indices.size());
    draw.material    = material;
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j <= sides; ++j) {
            const double     a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / sides;
            const glm::dvec3 normal(std::sin(a) * std::sin(b), std::cos(a), std::sin(a) * std::cos(b));
            add_vertex(scene, centre + radius * normal, normal, {0, 0});
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sides; ++j) {
            const uint32_t p = first + uint32_t(i * (sides + 1) + j), q = p + uint32_t(sides) + 1;
            for (const uint32_t index : {p, q, p + 1, p + 1, q, q + 1}) scene.indices.push_back(index);
        }
    }
    draw.index_count = uint32_t(scene.indices.size()) - draw.first_index;
    scene.draws.push_back(draw);
}

/// Large mirror floor at y = -1, front up.
inline void add_floor(Scene& scene, uint32_t material)
{
    add_quad(scene, material, {-200, -1, 10}, {400, 0, 0}, {0, 0, -400});
}

/// Large wall at Z = wall_m facing the camera.
inline void add_wall(Scene& scene, uint32_t material, double wall_m)
{
    add_quad(scene, material, {-200, -200, -wall_m}, {400, 0, 0}, {0, 400, 0});
}

} // namespace ssrlab::test
