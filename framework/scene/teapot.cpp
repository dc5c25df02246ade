// The teapot that Martin Newell measured in 1975, from his published Bezier control points.
// Body, lid, rim and bottom are surfaces of revolution, so their profiles are enough; handle and spout are given by one half.
#include "scene/mesh_repair.h"
#include "scene/shapes.h"

#include <array>
#include <cmath>

namespace ssrlab {
namespace {

using Curve = std::array<glm::dvec3, 4>; // control points, z up as published
using Patch = std::array<Curve, 4>;      // four curves along u, blended along v

// (radius, height), each from the axis or the mouth outwards and down.
constexpr std::array<std::array<glm::dvec2, 4>, 6> profiles = {{
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}}, // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}}},           // upper body
    {{{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},           // lower body
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0.0}, {0.0, 0.0}}},          // bottom
    {{{0.0, 3.15}, {0.8, 3.15}, {0.0, 2.85}, {0.2, 2.7}}},            // knob
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},             // lid
}};

// Rows of one half (y <= 0); the other half is the mirror image.
constexpr std::array<Curve, 7> handle = {{
    {{{-1.6, 0, 2.025}, {-1.6, -0.3, 2.025}, {-1.5, -0.3, 2.25}, {-1.5, 0, 2.25}}},
    {{{-2.3, 0, 2.025}, {-2.3, -0.3, 2.025}, {-2.5, -0.3, 2.25}, {-2.5, 0, 2.25}}},
    {{{-2.7, 0, 2.025}, {-2.7, -0.3, 2.025}, {-3.0, -0.3, 2.25}, {-3.0, 0, 2.25}}},
    {{{-2.7, 0, 1.8}, {-2.7, -0.3, 1.8}, {-3.0, -0.3, 1.8}, {-3.0, 0, 1.8}}},
    {{{-2.7, 0, 1.575}, {-2.7, -0.3, 1.575}, {-3.0, -0.3, 1.35}, {-3.0, 0, 1.35}}},
    {{{-2.5, 0, 1.125}, {-2.5, -0.3, 1.125}, {-2.65, -0.3, 0.9375}, {-2.65, 0, 0.9375}}},
    {{{-2.0, 0, 0.9}, {-2.0, -0.3, 0.9}, {-1.9, -0.3, 0.6}, {-1.9, 0, 0.6}}},
}};
constexpr std::array<Curve, 7> spout  = {{
     {{{1.7, 0, 1.425}, {1.7, -0.66, 1.425}, {1.7, -0.66, 0.6}, {1.7, 0, 0.6}}},
     {{{2.6, 0, 1.425}, {2.6, -0.66, 1.425}, {3.1, -0.66, 0.825}, {3.1, 0, 0.825}}},
     {{{2.3, 0, 2.1}, {2.3, -0.25, 2.1}, {2.4, -0.25, 2.025}, {2.4, 0, 2.025}}},
     {{{2.7, 0, 2.4}, {2.7, -0.25, 2.4}, {3.3, -0.25, 2.4}, {3.3, 0, 2.4}}},
     {{{2.8, 0, 2.475}, {2.8, -0.25, 2.475}, {3.525, -0.25, 2.49375}, {3.525, 0, 2.49375}}},
     {{{2.9, 0, 2.475}, {2.9, -0.15, 2.475}, {3.45, -0.15, 2.5125}, {3.45, 0, 2.5125}}},
     {{{2.8, 0, 2.4}, {2.8, -0.15, 2.4}, {3.2, -0.15, 2.4}, {3.2, 0, 2.4}}},
}};

glm::dvec3 bezier(const Curve& p, double t)
{
    const double s = 1 - t;
    return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
}

glm::dvec3 bezier_derivative(const Curve& p, double t)
{
    const double s = 1 - t;
    return 3 * s * s * (p[1] - p[0]) + 6 * s * t * (p[2] - p[1]) + 3 * t * t * (p[3] - p[2]);
}

/// A quarter of a turn; Newell's circle has its inner control points at 0.56 of the radius.
Patch quarter_turn(const std::array<glm::dvec2, 4>& profile, int quarter)
{
    constexpr double                           k    = 0.56;
    constexpr std::array<glm::dvec2, 4>        arc  = {{{1, 0}, {1, k}, {k, 1}, {0, 1}}};
    const std::array<std::array<double, 2>, 4> turn = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const auto [cosine, sine]                       = turn[static_cast<size_t>(quarter)];
    Patch patch{};
    for (size_t v = 0; v < 4; ++v)
        for (size_t u = 0; u < 4; ++u) {
            const glm::dvec2 xy =
                profile[v].x * glm::dvec2(arc[u].x * cosine - arc[u].y * sine, arc[u].x * sine + arc[u].y * cosine);
            patch[v][u] = {xy, profile[v].y};
        }
    return patch;
}

Patch tube_patch(const std::array<Curve, 7>& rows, size_t first_row, double side)
{
    Patch patch{};
    for (size_t v = 0; v < 4; ++v)
        for (size_t u = 0; u < 4; ++u) patch[v][u] = rows[first_row + v][u] * glm::dvec3(1, side, 1);
    return patch;
}

struct Surface {
    glm::dvec3 position, normal;
};

Surface evaluate(const Patch& patch, double u, double v)
{
    Curve along_v{};
    Curve along_v_du{};
    for (size_t i = 0; i < 4; ++i) {
        along_v[i]    = bezier(patch[i], u);
        along_v_du[i] = bezier_derivative(patch[i], u);
    }
    return {bezier(along_v, v), glm::cross(bezier(along_v_du, v), bezier_derivative(along_v, v))};
}

/// `outwards` tells on which side of the patch the outside lies.
void add_patch(Mesh& mesh, const Patch& patch, double outwards, int steps)
{
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    for (int row = 0; row <= steps; ++row)
        for (int column = 0; column <= steps; ++column) {
            const double u = static_cast<double>(column) / steps;
            const double v = static_cast<double>(row) / steps;
            Surface      s = evaluate(patch, u, v);
            // At the tips of lid and bottom a whole edge is one point: take the normal just beside it.
            if (glm::length(s.normal) < 1e-9) s.normal = evaluate(patch, u, v < 0.5 ? 1e-3 : 1 - 1e-3).normal;
            const glm::dvec3 normal = outwards * glm::normalize(s.normal);
            Vertex           vertex{};
            vertex.normal_ws = glm::vec3(normal.x, normal.z, -normal.y);
            vertex.uv0 = vertex.uv1 = glm::vec2(u, v);
            vertex.colour           = glm::vec4(1);
            mesh.positions_ws.emplace_back(s.position.x, s.position.z, -s.position.y);
            mesh.vertices.push_back(vertex);
        }
    const auto width = static_cast<uint32_t>(steps + 1);
    for (uint32_t row = 0; row + 1 < width; ++row)
        for (uint32_t column = 0; column + 1 < width; ++column) {
            const uint32_t a = first + row * width + column;
            const uint32_t b = outwards > 0 ? a + 1 : a + width;
            const uint32_t d = outwards > 0 ? a + width : a + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, a + width + 1, a, a + width + 1, d});
        }
}

} // namespace

Mesh make_teapot(int patch_steps)
{
    Mesh mesh;
    for (const auto& profile : profiles)
        for (int quarter = 0; quarter < 4; ++quarter)
            // All profiles run the same way round, so the outside is on the same side of all.
            add_patch(mesh, quarter_turn(profile, quarter), -1, patch_steps);
    for (const auto& rows : {handle, spout})
        for (size_t first_row : {size_t{0}, size_t{3}})
            for (double side : {1.0, -1.0}) add_patch(mesh, tube_patch(rows, first_row, side), side, patch_steps);
    drop_bad_triangles(mesh); // at the tips of lid and bottom a quad is a triangle
    mesh.name = "teapot";
    return mesh;
}

} // namespace ssrlab
