#include "scene/gltf.h"

#include <algorithm>
#include <numeric>

namespace ssrlab::gltf {

int attribute(const tinygltf::Primitive& primitive, const char* name)
{
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

std::vector<float> rows_of(const Import& import, const tinygltf::Primitive& primitive, const char* name, int components,
                           size_t vertex_count, const std::string& where)
{
    const int accessor = attribute(primitive, name);
    if (accessor < 0) return {};
    const std::string  place = fmt::format("{}/attributes/{}", where, name);
    std::vector<float> rows  = read_floats(import, accessor, components, place);
    if (rows.size() != vertex_count * static_cast<size_t>(components))
        import.fail("{}: {} elements for {} positions", place, rows.size() / static_cast<size_t>(components),
                    vertex_count);
    return rows;
}

namespace {

/// The corners of the primitive's triangles: its indices, or all its vertices in order.
std::vector<uint32_t> read_corners(const Import& import, const tinygltf::Primitive& primitive, size_t vertex_count,
                                   const std::string& where)
{
    if (primitive.indices < 0) {
        std::vector<uint32_t> corners(vertex_count);
        std::iota(corners.begin(), corners.end(), 0U);
        return corners;
    }
    std::vector<uint32_t> corners = read_indices(import, primitive.indices, where + "/indices");
    const auto beyond = std::ranges::find_if(corners, [&](uint32_t corner) { return corner >= vertex_count; });
    if (beyond != corners.end())
        import.fail("{}/indices: index {} is out of range, there are {} vertices", where, *beyond, vertex_count);
    return corners;
}

/// Which vertices the corners name, in order; the corners then name places in this list. Primitives may share one long list of vertices.
std::vector<uint32_t> take_used(std::vector<uint32_t>& corners, size_t vertex_count)
{
    std::vector<uint32_t> place(vertex_count, 0), used;
    for (const uint32_t corner : corners) place[corner] = 1;
    for (uint32_t i = 0; i < vertex_count; ++i) {
        if (place[i] == 0) continue;
        place[i] = static_cast<uint32_t>(used.size());
        used.push_back(i);
    }
    for (uint32_t& corner : corners) corner = place[corner];
    return used;
}

/// What an accessor of whole numbers can hold at most; 1 where their shares of that are meant.
float largest_unless_normalized(const tinygltf::Accessor& accessor)
{
    if (accessor.normalized) return 1;
    if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return 255;
    return accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 65535 : 1;
}

void read_colours(Import& import, const tinygltf::Primitive& primitive, size_t vertex_count,
                  const std::vector<float>& morph_weights, const std::vector<uint32_t>& used, Mesh& mesh,
                  const std::string& where)
{
    const int accessor = attribute(primitive, "COLOR_0");
    if (accessor < 0) return;
    if (primitive.material >= 0 &&
        import.json.materials[size_t(primitive.material)].extensions.contains("KHR_materials_unlit"))
        import.warn(fmt::format("{}: vertex colours of an unlit material are not supported; it has one colour", where));
    const int          components = component_count(import, accessor, where) == 4 ? 4 : 3;
    std::vector<float> rows       = rows_of(import, primitive, "COLOR_0", components, vertex_count, where);
    if (const float largest = largest_unless_normalized(import.json.accessors[size_t(accessor)]); largest > 1) {
        import.warn(fmt::format("{}/attributes/COLOR_0: whole numbers that are not 'normalized': they count as shares "
                                "of {}",
                                where, largest));
        for (float& value : rows) value /= largest;
    }
    add_morph_targets(import, primitive, "COLOR_0", components, components, morph_weights, rows, where);
    for (size_t i = 0; i < used.size(); ++i)
        for (int c = 0; c < components; ++c)
            mesh.vertices[i].colour[c] = rows[used[i] * static_cast<size_t>(components) + static_cast<size_t>(c)];
}

/// Strips and fans as single triangles, with the winding that glTF defines.
std::vector<uint32_t> to_triangles(const std::vector<uint32_t>& corners, int mode)
{
    std::vector<uint32_t> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles = corners;
        triangles.resize(corners.size() / 3 * 3);
        return triangles;
    }
    for (size_t i = 0; i + 2 < corners.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
        else
            triangles.insert(triangles.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    }
    return triangles;
}

void read_triangles(Import& import, const tinygltf::Primitive& primitive, int mode,
                    const std::vector<float>& morph_weights, Mesh& mesh, const std::string& where)
{
    std::vector<float> positions =
        read_floats(import, attribute(primitive, "POSITION"), 3, where + "/attributes/POSITION");
    const size_t                count    = positions.size() / 3;
    std::vector<uint32_t>       corners  = read_corners(import, primitive, count, where);
    const std::vector<uint32_t> used     = take_used(corners, count);
    std::vector<float>          normals  = rows_of(import, primitive, "NORMAL", 3, count, where);
    std::vector<float>          tangents = rows_of(import, primitive, "TANGENT", 4, count, where);
    std::vector<float>          uv0      = rows_of(import, primitive, "TEXCOORD_0", 2, count, where);
    std::vector<float>          uv1      = rows_of(import, primitive, "TEXCOORD_1", 2, count, where);
    add_morph_targets(import, primitive, "POSITION", 3, 3, morph_weights, positions, where);
    add_morph_targets(import, primitive, "NORMAL", 3, 3, morph_weights, normals, where);
    add_morph_targets(import, primitive, "TANGENT", 4, 3, morph_weights, tangents, where);
    add_morph_targets(import, primitive, "TEXCOORD_0", 2, 2, morph_weights, uv0, where);
    add_morph_targets(import, primitive, "TEXCOORD_1", 2, 2, morph_weights, uv1, where);
    mesh.has_normals  = !normals.empty();
    mesh.has_tangents = !tangents.empty() && mesh.has_normals;
    mesh.positions_ws.reserve(used.size());
    mesh.vertices.reserve(used.size());
    for (const size_t i : used) {
        Vertex vertex{};
        vertex.normal_ws = {0, 1, 0};
        vertex.colour    = glm::vec4(1);
        if (mesh.has_normals) vertex.normal_ws = {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]};
        if (mesh.has_tangents)
            vertex.tangent_ws = {tangents[4 * i], tangents[4 * i + 1], tangents[4 * i + 2], tangents[4 * i + 3]};
        if (!uv0.empty()) vertex.uv0 = {uv0[2 * i], uv0[2 * i + 1]};
        if (!uv1.empty()) vertex.uv1 = {uv1[2 * i], uv1[2 * i + 1]};
        mesh.positions_ws.emplace_back(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
        mesh.vertices.push_back(vertex);
    }
    read_colours(import, primitive, count, morph_weights, used, mesh, where);
    mesh.skin.vertices = read_influences(import, primitive, count, used, where);
    mesh.indices       = to_triangles(corners, mode);
}

/// Of a mesh without texture coordinates all have the value of the texture's corner.
void warn_of_missing_coordinates(Import& import, const tinygltf::Primitive& primitive, const Material& material,
                                 const std::string& where)
{
    for (const TextureUse* use : {&material.base_colour_texture, &material.metallic_roughness_texture,
                                  &material.normal_texture, &material.emissive_texture}) {
        const std::string name = fmt::format("TEXCOORD_{}", use->uv_set);
        if (use->texture >= 0 && attribute(primitive, name.c_str()) < 0)
            import.warn(fmt::format("{}/attributes has no {}, which its material's textures need: they show one texel",
                                    where, name));
    }
}

} // namespace

std::vector<Mesh> read_mesh(Import& import, int mesh_index, const std::vector<float>& morph_weights,
                            const std::vector<bool>& material_left_out)
{
    const tinygltf::Mesh& source = import.json.meshes[static_cast<size_t>(mesh_index)];
    std::vector<Mesh>     meshes;
    for (size_t i = 0; i < source.primitives.size(); ++i) {
        const tinygltf::Primitive& primitive = source.primitives[i];
        const std::string          where     = fmt::format("/meshes/{}/primitives/{}", mesh_index, i);
        const int                  mode      = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode > TINYGLTF_MODE_TRIANGLE_FAN) import.fail("{}/mode {} is unknown", where, mode);
        if (mode < TINYGLTF_MODE_TRIANGLES) {
            import.warn("points and lines are not drawn");
            continue;
        }
        if (attribute(primitive, "POSITION") < 0) {
            import.warn(fmt::format("{} has no positions; left out", where));
            continue;
        }
        if (primitive.material >= static_cast<int>(import.json.materials.size()))
            import.fail("{}/material: there is no material {}", where, primitive.material);
        Mesh mesh;
        mesh.name     = source.name.empty() ? fmt::format("mesh {}", mesh_index) : source.name;
        mesh.material = static_cast<uint32_t>(primitive.material >= 0 ? primitive.material
                                                                      : static_cast<int>(material_left_out.size()) - 1);
        if (material_left_out[mesh.material]) continue;
        read_triangles(import, primitive, mode, morph_weights, mesh, where);
        warn_of_missing_coordinates(import, primitive, import.model.materials[mesh.material], where);
        meshes.push_back(std::move(mesh));
    }
    return meshes;
}

} // namespace ssrlab::gltf
