#include "scene/mesh_repair.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <numeric>
#include <string_view>
#include <unordered_map>

namespace ssrlab {
namespace {

struct Corners {
    glm::dvec3 a, b, c;
};

Corners corners_of(const Mesh& mesh, size_t first)
{
    return {mesh.positions_ws[mesh.indices[first]], mesh.positions_ws[mesh.indices[first + 1]],
            mesh.positions_ws[mesh.indices[first + 2]]};
}

/// Twice the area, along the triangle's front.
glm::dvec3 area_vector(const Corners& corners) { return glm::cross(corners.b - corners.a, corners.c - corners.a); }

bool has_area(const Corners& corners)
{
    const double longest_sq = std::max({glm::dot(corners.b - corners.a, corners.b - corners.a),
                                        glm::dot(corners.c - corners.b, corners.c - corners.b),
                                        glm::dot(corners.a - corners.c, corners.a - corners.c)});
    // Thinner than float can resolve: no direction to face.
    return glm::length(area_vector(corners)) > 1e-7 * longest_sq && longest_sq > 1e-24;
}

void keep_vertices(Mesh& mesh, const std::vector<uint32_t>& kept)
{
    std::vector<glm::dvec3> positions;
    std::vector<Vertex>     vertices;
    std::vector<Influences> influences;
    positions.reserve(kept.size());
    vertices.reserve(kept.size());
    for (uint32_t old_index : kept) {
        positions.push_back(mesh.positions_ws[old_index]);
        vertices.push_back(mesh.vertices[old_index]);
        if (!mesh.skin.vertices.empty()) influences.push_back(mesh.skin.vertices[old_index]);
    }
    mesh.positions_ws  = std::move(positions);
    mesh.vertices      = std::move(vertices);
    mesh.skin.vertices = std::move(influences);
}

void drop_unused_vertices(Mesh& mesh)
{
    constexpr uint32_t    unused = ~0U;
    std::vector<uint32_t> target(mesh.positions_ws.size(), unused);
    std::vector<uint32_t> kept;
    for (uint32_t& index : mesh.indices) {
        if (target[index] == unused) {
            target[index] = static_cast<uint32_t>(kept.size());
            kept.push_back(index);
        }
        index = target[index];
    }
    if (kept.size() != mesh.positions_ws.size() || !std::ranges::is_sorted(kept)) keep_vertices(mesh, kept);
}

/// Gives every triangle its own three vertices.
void split_vertices(Mesh& mesh)
{
    const std::vector<uint32_t> kept = mesh.indices;
    keep_vertices(mesh, kept);
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0U);
}

struct PositionHash {
    size_t operator()(const glm::dvec3& p) const
    {
        std::array<uint64_t, 3> bits{};
        const glm::dvec3        canonical = p + 0.0; // -0 and 0 are one position
        std::memcpy(bits.data(), &canonical, sizeof bits);
        return static_cast<size_t>((bits[0] * 0x9E3779B97F4A7C15ULL ^ bits[1]) * 0xC2B2AE3D27D4EB4FULL ^ bits[2]) *
               0x165667B19E3779F9ULL;
    }
};

/// For each corner (index into mesh.indices) the number of its position.
std::vector<uint32_t> weld_positions(const Mesh& mesh, size_t& position_count)
{
    std::unordered_map<glm::dvec3, uint32_t, PositionHash> numbers;
    numbers.reserve(mesh.positions_ws.size());
    std::vector<uint32_t> vertex_number(mesh.positions_ws.size());
    for (size_t i = 0; i < vertex_number.size(); ++i)
        vertex_number[i] =
            numbers.try_emplace(mesh.positions_ws[i], static_cast<uint32_t>(numbers.size())).first->second;
    position_count = numbers.size();
    std::vector<uint32_t> corner_number(mesh.indices.size());
    std::ranges::transform(mesh.indices, corner_number.begin(), [&](uint32_t i) { return vertex_number[i]; });
    return corner_number;
}

/// Vertices with the same source and normal become one again.
void weld_split_vertices(Mesh& mesh, const std::vector<uint32_t>& source)
{
    using Key = std::array<uint32_t, 4>;
    std::map<Key, uint32_t> numbers;
    std::vector<uint32_t>   kept;
    for (size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        Key key{source[corner]};
        std::memcpy(&key[1], &mesh.vertices[corner].normal_ws, sizeof(glm::vec3));
        const auto [found, added] = numbers.try_emplace(key, static_cast<uint32_t>(kept.size()));
        if (added) kept.push_back(static_cast<uint32_t>(corner));
        mesh.indices[corner] = found->second;
    }
    keep_vertices(mesh, kept);
}

/// A triangle in the texture: from its first corner to the second and third.
struct UvEdges {
    glm::dvec2 du{0}, dv{0};
    int        side = 0; // -1: it lies there mirrored; 0: it has no area there
};

UvEdges uv_edges(const Mesh& mesh, size_t first, int uv_set, const glm::mat3& uv_transform)
{
    const glm::dmat2 turn = glm::dmat2(glm::mat2(uv_transform));
    const auto       uv   = [&](size_t corner) {
        const Vertex& vertex = mesh.vertices[mesh.indices[corner]];
        return glm::dvec2(uv_set == 0 ? vertex.uv0 : vertex.uv1);
    };
    const glm::dvec2 du = turn * (uv(first + 1) - uv(first)), dv = turn * (uv(first + 2) - uv(first));
    const double     determinant = du.x * dv.y - dv.x * du.y;
    if (determinant == 0 || !std::isfinite(determinant)) return {};
    return {du, dv, determinant > 0 ? 1 : -1};
}

/// Gives a vertex without a tangent a copy where triangles of both sides share it: their tangents differ there.
void split_mirrored(Mesh& mesh, const std::vector<UvEdges>& edges)
{
    std::vector<int>                       side_of(mesh.vertices.size(), 0);
    std::vector<uint32_t>                  kept(mesh.vertices.size());
    std::unordered_map<uint32_t, uint32_t> copies;
    std::iota(kept.begin(), kept.end(), 0U);
    for (size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        uint32_t& index = mesh.indices[corner];
        const int side  = edges[corner / 3].side;
        if (side == 0 || mesh.vertices[index].tangent_ws.w != 0) continue;
        if (side_of[index] == 0) side_of[index] = side;
        if (side_of[index] == side) continue;
        const auto [copy, added] = copies.try_emplace(index, static_cast<uint32_t>(kept.size()));
        if (added) kept.push_back(index);
        index = copy->second;
    }
    if (!copies.empty()) keep_vertices(mesh, kept);
}

} // namespace

size_t drop_bad_triangles(Mesh& mesh)
{
    size_t end = 0, unusable = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Corners corners = corners_of(mesh, i);
        const bool    places  = usable(corners.a) && usable(corners.b) && usable(corners.c);
        unusable += !places;
        if (!places || !has_area(corners)) continue;
        std::copy_n(mesh.indices.begin() + static_cast<std::ptrdiff_t>(i), 3,
                    mesh.indices.begin() + static_cast<std::ptrdiff_t>(end));
        end += 3;
    }
    mesh.indices.resize(end);
    drop_unused_vertices(mesh);
    return unusable;
}

std::string dropped_triangles_text(size_t count)
{
    return fmt::format("{} triangles dropped: positions that are not finite, or too large to compute with", count);
}

void weld_equal_vertices(Mesh& mesh)
{
    // The bytes of a vertex: three doubles and a Vertex without padding.
    static_assert(sizeof(Vertex) == 21 * sizeof(float));
    std::vector<uint32_t> kept;
    const auto            bytes_of = [&](uint32_t i) {
        std::array<char, sizeof(glm::dvec3) + sizeof(Vertex)> bytes{};
        std::memcpy(bytes.data(), &mesh.positions_ws[i], sizeof(glm::dvec3));
        std::memcpy(bytes.data() + sizeof(glm::dvec3), &mesh.vertices[i], sizeof(Vertex));
        return bytes;
    };
    const auto hash = [&](uint32_t i) {
        const auto bytes = bytes_of(i);
        return std::hash<std::string_view>{}({bytes.data(), bytes.size()});
    };
    const auto equal = [&](uint32_t a, uint32_t b) { return bytes_of(a) == bytes_of(b); };
    std::unordered_map<uint32_t, uint32_t, decltype(hash), decltype(equal)> numbers(mesh.vertices.size(), hash, equal);
    for (uint32_t& index : mesh.indices) {
        const auto [found, added] = numbers.try_emplace(index, static_cast<uint32_t>(kept.size()));
        if (added) kept.push_back(index);
        index = found->second;
    }
    keep_vertices(mesh, kept);
}

void turn_fronts_to_normals(Mesh& mesh)
{
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        glm::dvec3 normal(0);
        for (size_t corner = i; corner < i + 3; ++corner)
            normal += glm::dvec3(mesh.vertices[mesh.indices[corner]].normal_ws);
        if (glm::dot(normal, area_vector(corners_of(mesh, i))) < 0) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
    }
}

void make_flat_normals(Mesh& mesh)
{
    split_vertices(mesh);
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto normal = glm::vec3(glm::normalize(area_vector(corners_of(mesh, i))));
        for (size_t corner = i; corner < i + 3; ++corner) mesh.vertices[corner].normal_ws = normal;
    }
    mesh.has_normals = true;
}

void make_smooth_normals(Mesh& mesh, double crease_deg)
{
    size_t                      position_count = 0;
    const std::vector<uint32_t> number         = weld_positions(mesh, position_count);
    const std::vector<uint32_t> source         = mesh.indices;
    split_vertices(mesh);

    // Corners sorted by position (counting sort), so that the triangles around one are side by side.
    std::vector<uint32_t> first(position_count + 1, 0);
    for (uint32_t n : number) ++first[n + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<uint32_t> next = first;
    std::vector<uint32_t> sorted(number.size());
    for (uint32_t corner = 0; corner < number.size(); ++corner) sorted[next[number[corner]]++] = corner;

    std::vector<glm::dvec3> area(mesh.indices.size() / 3);
    for (size_t i = 0; i < area.size(); ++i) area[i] = area_vector(corners_of(mesh, 3 * i));
    const double crease_cos = std::cos(crease_deg * std::numbers::pi / 180);
    for (size_t corner = 0; corner < number.size(); ++corner) {
        const glm::dvec3 own = area[corner / 3];
        glm::dvec3       sum(0);
        for (uint32_t i = first[number[corner]]; i < first[number[corner] + 1]; ++i) {
            const glm::dvec3 other = area[sorted[i] / 3];
            if (glm::dot(own, other) >= crease_cos * glm::length(own) * glm::length(other)) sum += other;
        }
        mesh.vertices[corner].normal_ws = glm::vec3(glm::normalize(glm::length(sum) > 0 ? sum : own));
    }
    weld_split_vertices(mesh, source);
    mesh.has_normals = true;
}

size_t make_tangents(Mesh& mesh, int uv_set, const glm::mat3& uv_transform)
{
    std::vector<UvEdges> edges;
    edges.reserve(mesh.indices.size() / 3);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) edges.push_back(uv_edges(mesh, i, uv_set, uv_transform));
    split_mirrored(mesh, edges);
    std::vector<glm::dvec3> along_u(mesh.vertices.size(), glm::dvec3(0));
    std::vector<glm::dvec3> along_v(mesh.vertices.size(), glm::dvec3(0));
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Corners corners      = corners_of(mesh, i);
        const auto& [du, dv, side] = edges[i / 3];
        if (side == 0) continue;
        // Weighted by area in space, not in the texture.
        const glm::dvec3 u = double(side) * (dv.y * (corners.b - corners.a) - du.y * (corners.c - corners.a));
        const glm::dvec3 v = double(side) * (du.x * (corners.c - corners.a) - dv.x * (corners.b - corners.a));
        for (size_t corner = i; corner < i + 3; ++corner) {
            along_u[mesh.indices[corner]] += u;
            along_v[mesh.indices[corner]] += v;
        }
    }
    size_t made = 0;
    for (size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (mesh.vertices[i].tangent_ws.w != 0) continue;
        ++made;
        const glm::dvec3 normal  = mesh.vertices[i].normal_ws;
        glm::dvec3       tangent = along_u[i] - normal * glm::dot(normal, along_u[i]);
        if (!(glm::length(tangent) > 1e-12 * glm::length(along_u[i])))
            tangent = glm::cross(normal, std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
        // A normal map's y points up in the picture, v down.
        const float handedness      = glm::dot(glm::cross(normal, tangent), along_v[i]) > 0 ? -1.0F : 1.0F;
        mesh.vertices[i].tangent_ws = {glm::vec3(glm::normalize(tangent)), handedness};
    }
    return made;
}

size_t replace_bad_normals(Mesh& mesh)
{
    const auto is_bad = [&](uint32_t index) {
        const float length = glm::length(mesh.vertices[index].normal_ws);
        return !std::isfinite(length) || length <= 1e-6F;
    };
    std::vector<uint32_t>  kept(mesh.vertices.size());
    std::vector<glm::vec3> normals; // of those added
    std::iota(kept.begin(), kept.end(), 0U);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto own = glm::vec3(glm::normalize(area_vector(corners_of(mesh, i))));
        for (size_t corner = i; corner < i + 3; ++corner) {
            if (!is_bad(mesh.indices[corner])) continue;
            kept.push_back(mesh.indices[corner]);
            normals.push_back(own);
            mesh.indices[corner] = static_cast<uint32_t>(kept.size() - 1);
        }
    }
    if (normals.empty()) return 0;
    const size_t before = mesh.vertices.size();
    keep_vertices(mesh, kept);
    for (size_t i = 0; i < normals.size(); ++i) mesh.vertices[before + i].normal_ws = normals[i];
    drop_unused_vertices(mesh);
    return normals.size();
}

void clean_attributes(Mesh& mesh)
{
    const auto finite = [](const auto& v) {
        for (int i = 0; i < v.length(); ++i)
            if (!std::isfinite(v[i])) return false;
        return true;
    };
    for (Vertex& vertex : mesh.vertices) {
        if (!finite(vertex.uv0)) vertex.uv0 = {0, 0};
        if (!finite(vertex.uv1)) vertex.uv1 = {0, 0};
        vertex.colour              = finite(vertex.colour) ? glm::clamp(vertex.colour, 0.0F, 1.0F) : glm::vec4(1);
        vertex.normal_ws           = vertex.normal_ws / glm::length(vertex.normal_ws);
        const glm::vec3 tangent    = glm::vec3(vertex.tangent_ws);
        const float     length     = glm::length(tangent);
        const float     off_normal = glm::length(glm::cross(vertex.normal_ws, tangent)); // what a shader can use of it
        if (std::isfinite(length) && off_normal > 1e-3F * length && length > 1e-6F && finite(vertex.tangent_ws) &&
            vertex.tangent_ws.w != 0)
            vertex.tangent_ws = {tangent / length, vertex.tangent_ws.w < 0 ? -1.0F : 1.0F};
        else
            vertex.tangent_ws = glm::vec4(0);
    }
}

} // namespace ssrlab
