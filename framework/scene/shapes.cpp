#include "scene/shapes.h"

#include "scene/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

void add_vertex(Mesh& mesh, glm::dvec3 position_ws, glm::dvec3 normal_ws, glm::dvec2 uv)
{
    Vertex vertex{};
    vertex.normal_ws = glm::vec3(normal_ws);
    vertex.uv0 = vertex.uv1 = glm::vec2(uv);
    vertex.colour           = glm::vec4(1);
    mesh.positions_ws.push_back(position_ws);
    mesh.vertices.push_back(vertex);
}

void add_triangle(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c)
{
    mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// Triangles between rows of `columns + 1` vertices each.
void add_grid(Mesh& mesh, uint32_t first, int columns, int rows)
{
    const auto width = static_cast<uint32_t>(columns + 1);
    for (uint32_t row = 0; row < static_cast<uint32_t>(rows); ++row)
        for (uint32_t column = 0; column < static_cast<uint32_t>(columns); ++column) {
            const uint32_t corner = first + row * width + column;
            add_triangle(mesh, corner, corner + 1, corner + width + 1);
            add_triangle(mesh, corner, corner + width + 1, corner + width);
        }
}

uint8_t to_byte(float value) { return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255)); }

} // namespace

Mesh make_quad(glm::dvec3 corner_ws, glm::dvec3 edge_u_ws, glm::dvec3 edge_v_ws)
{
    Mesh             mesh;
    const glm::dvec3 normal = glm::normalize(glm::cross(edge_u_ws, edge_v_ws));
    const double     u_m    = glm::length(edge_u_ws);
    const double     v_m    = glm::length(edge_v_ws);
    add_vertex(mesh, corner_ws, normal, {0, v_m});
    add_vertex(mesh, corner_ws + edge_u_ws, normal, {u_m, v_m});
    add_vertex(mesh, corner_ws + edge_u_ws + edge_v_ws, normal, {u_m, 0});
    add_vertex(mesh, corner_ws + edge_v_ws, normal, {0, 0});
    add_triangle(mesh, 0, 1, 2);
    add_triangle(mesh, 0, 2, 3);
    return mesh;
}

Mesh make_box(glm::dvec3 min_ws, glm::dvec3 max_ws)
{
    const glm::dvec3 size = max_ws - min_ws;
    const glm::dvec3 x{size.x, 0, 0};
    const glm::dvec3 y{0, size.y, 0};
    const glm::dvec3 z{0, 0, size.z};
    Mesh             mesh = make_quad(min_ws + z, x, y);
    append(mesh, make_quad(max_ws - y - z, -x, y));
    append(mesh, make_quad(min_ws, z, y));
    append(mesh, make_quad(max_ws - y, -z, y));
    append(mesh, make_quad(max_ws - x, x, -z));
    append(mesh, make_quad(min_ws, x, z));
    return mesh;
}

Mesh make_sphere(glm::dvec3 centre_ws, double radius_m, int slices, int stacks)
{
    Mesh mesh;
    for (int stack = 0; stack <= stacks; ++stack)
        for (int slice = 0; slice <= slices; ++slice) {
            const double     v     = static_cast<double>(stack) / stacks;
            const double     u     = static_cast<double>(slice) / slices;
            const double     polar = (1 - v) * std::numbers::pi; // from the bottom up
            const double     angle = 2 * std::numbers::pi * u;
            const glm::dvec3 normal{std::sin(polar) * std::sin(angle), std::cos(polar),
                                    std::sin(polar) * std::cos(angle)};
            const double     around_m = std::numbers::pi * radius_m;
            add_vertex(mesh, centre_ws + radius_m * normal, normal, {2 * around_m * u, around_m * (1 - v)});
        }
    add_grid(mesh, 0, slices, stacks);
    drop_bad_triangles(mesh); // at the poles a quad is a triangle
    return mesh;
}

Mesh make_cylinder(glm::dvec3 base_ws, double radius_m, double height_m, int slices)
{
    Mesh       mesh;
    const auto rim = [&](int slice) {
        const double angle = 2 * std::numbers::pi * slice / slices;
        return glm::dvec3(std::sin(angle), 0, std::cos(angle));
    };
    for (double y_m : {0.0, height_m})
        for (int slice = 0; slice <= slices; ++slice)
            add_vertex(mesh, base_ws + radius_m * rim(slice) + glm::dvec3(0, y_m, 0), rim(slice),
                       {2 * std::numbers::pi * radius_m * slice / slices, height_m - y_m});
    add_grid(mesh, 0, slices, 1);
    for (double side : {-1.0, 1.0}) {
        const auto       centre = static_cast<uint32_t>(mesh.vertices.size());
        const glm::dvec3 middle = base_ws + glm::dvec3(0, side > 0 ? height_m : 0, 0);
        add_vertex(mesh, middle, {0, side, 0}, {0, 0});
        for (int slice = 0; slice <= slices; ++slice)
            add_vertex(mesh, middle + radius_m * rim(slice), {0, side, 0},
                       radius_m * glm::dvec2(rim(slice).x, rim(slice).z));
        for (uint32_t slice = 1; slice <= static_cast<uint32_t>(slices); ++slice)
            if (side > 0)
                add_triangle(mesh, centre, centre + slice, centre + slice + 1);
            else
                add_triangle(mesh, centre, centre + slice + 1, centre + slice);
    }
    return mesh;
}

void multiply_uv(Mesh& mesh, double factor)
{
    for (Vertex& vertex : mesh.vertices) {
        vertex.uv0 *= static_cast<float>(factor);
        vertex.uv1 *= static_cast<float>(factor);
    }
}

Texture make_checker_texture(glm::vec3 colour_a, glm::vec3 colour_b)
{
    constexpr int side_px = 32;
    Texture       texture;
    texture.size_px = {side_px, side_px};
    texture.srgb    = true;
    texture.nearest = true;
    for (int y = 0; y < side_px; ++y)
        for (int x = 0; x < side_px; ++x) {
            const glm::vec3 colour = (x < side_px / 2) == (y < side_px / 2) ? colour_a : colour_b;
            texture.rgba.insert(texture.rgba.end(), {to_byte(colour.r), to_byte(colour.g), to_byte(colour.b), 255});
        }
    return texture;
}

Texture make_wave_normals()
{
    constexpr int side_px = 64;
    Texture       texture;
    texture.size_px    = {side_px, side_px};
    const auto slope   = [](int i) { return std::cos(2 * std::numbers::pi * (i + 0.5) / side_px); };
    const auto to_byte = [](double value) { return static_cast<uint8_t>(std::lround(127.5 * value + 127.5)); };
    for (int y = 0; y < side_px; ++y)
        for (int x = 0; x < side_px; ++x) {
            const glm::dvec3 normal = glm::normalize(glm::dvec3(slope(x), slope(y), 1));
            texture.rgba.insert(texture.rgba.end(), {to_byte(normal.x), to_byte(normal.y), to_byte(normal.z), 255});
        }
    return texture;
}

float ior_to_f0(double ior)
{
    const double r = (ior - 1) / (ior + 1);
    return static_cast<float>(r * r);
}

Material make_material(const std::string& name, glm::vec3 base_colour, float metallic, float roughness)
{
    Material material;
    material.name        = name;
    material.base_colour = {base_colour, 1};
    material.metallic    = metallic;
    material.roughness   = roughness;
    return material;
}

} // namespace ssrlab
