#include "scene/model.h"

#include "scene/skin.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

glm::vec3 unit_or(glm::dvec3 v, glm::vec3 otherwise)
{
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : otherwise;
}

glm::dvec3 point(const glm::dmat4& matrix, glm::dvec3 p) { return glm::dvec3(matrix * glm::dvec4(p, 1)); }

bool same(const Texture& a, const Texture& b)
{
    return a.size_px == b.size_px && a.srgb == b.srgb && a.nearest == b.nearest && a.mipmaps == b.mipmaps &&
           a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.rgba == b.rgba;
}

bool same(const TextureUse& a, const TextureUse& b)
{
    return a.texture == b.texture && a.uv_set == b.uv_set && a.uv_transform == b.uv_transform;
}

bool same(const Material& a, const Material& b)
{
    return a.name == b.name && a.base_colour == b.base_colour && a.metallic == b.metallic &&
           a.dielectric_f0 == b.dielectric_f0 && a.roughness == b.roughness && a.emissive == b.emissive &&
           a.normal_scale == b.normal_scale && a.double_sided == b.double_sided && a.alpha_mask == b.alpha_mask &&
           a.alpha_cutoff == b.alpha_cutoff && same(a.base_colour_texture, b.base_colour_texture) &&
           same(a.metallic_roughness_texture, b.metallic_roughness_texture) &&
           same(a.normal_texture, b.normal_texture) && same(a.emissive_texture, b.emissive_texture);
}

/// Keeps the first of equal items, and none that is unused; returns where each item went.
template <typename Item> std::vector<int> keep_first_of_equal(std::vector<Item>& items, const std::vector<bool>& used)
{
    std::vector<Item> kept;
    std::vector<int>  target(items.size(), -1);
    for (size_t i = 0; i < items.size(); ++i) {
        if (!used[i]) continue;
        const auto found = std::ranges::find_if(kept, [&](const Item& other) { return same(items[i], other); });
        target[i]        = static_cast<int>(found - kept.begin());
        if (found == kept.end()) kept.push_back(std::move(items[i]));
    }
    items = std::move(kept);
    return target;
}

template <typename Function> void for_each_texture_use(Material& material, Function function)
{
    for (TextureUse* use : {&material.base_colour_texture, &material.metallic_roughness_texture,
                            &material.normal_texture, &material.emissive_texture})
        if (use->texture >= 0) function(*use);
}

} // namespace

bool usable(glm::dvec3 position_ws)
{
    constexpr double limit_m = 1e12;
    return std::abs(position_ws.x) < limit_m && std::abs(position_ws.y) < limit_m && std::abs(position_ws.z) < limit_m;
}

void Bounds::add(glm::dvec3 position_ws)
{
    min_ws = glm::min(min_ws, position_ws);
    max_ws = glm::max(max_ws, position_ws);
}

Bounds bounds_of(const Model& model, const glm::dmat4& matrix)
{
    Bounds bounds;
    for (const Mesh& mesh : model.meshes)
        for (const glm::dvec3& position : mesh.positions_ws)
            if (usable(position)) bounds.add(point(matrix, position));
    return bounds;
}

Poses transform(const Poses& poses, const glm::dmat4& matrix)
{
    if (!poses) return nullptr;
    const glm::dmat4 back  = glm::inverse(matrix);
    auto             moved = std::make_shared<std::vector<glm::dmat4>>();
    for (const glm::dmat4& pose : *poses) moved->push_back(matrix * pose * back);
    return moved;
}

JointPoses transform(const JointPoses& joints, const glm::dmat4& matrix)
{
    if (!joints) return nullptr;
    auto moved = std::make_shared<std::vector<std::vector<glm::dmat4>>>(*joints);
    for (std::vector<glm::dmat4>& frame : *moved)
        for (glm::dmat4& joint : frame) joint = matrix * joint;
    return moved;
}

void transform(Mesh& mesh, const glm::dmat4& matrix)
{
    for (size_t i = 0; i < mesh.vertices.size(); ++i) move_vertex(matrix, mesh.positions_ws[i], mesh.vertices[i]);
    mesh.motion.poses = transform(mesh.motion.poses, matrix);
    mesh.skin.joints  = transform(mesh.skin.joints, matrix);
    if (glm::determinant(glm::dmat3(matrix)) < 0)
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

void transform(Model& model, const glm::dmat4& matrix)
{
    for (Mesh& mesh : model.meshes) transform(mesh, matrix);
    for (ModelLight& light : model.lights) {
        light.position_ws = point(matrix, light.position_ws);
        light.light.direction_ws =
            unit_or(glm::dmat3(matrix) * glm::dvec3(light.light.direction_ws), light.light.direction_ws);
    }
    for (Camera& camera : model.cameras) {
        camera.position_ws = point(matrix, camera.position_ws);
        camera.target_ws   = point(matrix, camera.target_ws);
        camera.up_ws       = glm::dvec3(unit_or(glm::dmat3(matrix) * camera.up_ws, {0, 1, 0}));
    }
}

void append(Model& model, Model part)
{
    const auto first_material = static_cast<uint32_t>(model.materials.size());
    const auto first_texture  = static_cast<int>(model.textures.size());
    for (Material& material : part.materials) {
        for_each_texture_use(material, [&](TextureUse& use) { use.texture += first_texture; });
        model.materials.push_back(std::move(material));
    }
    for (Mesh& mesh : part.meshes) {
        mesh.material += first_material;
        model.meshes.push_back(std::move(mesh));
    }
    std::ranges::move(part.textures, std::back_inserter(model.textures));
    std::ranges::move(part.lights, std::back_inserter(model.lights));
    std::ranges::move(part.cameras, std::back_inserter(model.cameras));
    std::ranges::move(part.warnings, std::back_inserter(model.warnings));
}

void append(Mesh& mesh, const Mesh& part)
{
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.positions_ws.insert(mesh.positions_ws.end(), part.positions_ws.begin(), part.positions_ws.end());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (uint32_t index : part.indices) mesh.indices.push_back(first + index);
}

void merge_duplicates(Model& model)
{
    std::vector<bool> material_used(model.materials.size(), false);
    for (const Mesh& mesh : model.meshes) material_used.at(mesh.material) = true;
    std::vector<bool> texture_used(model.textures.size(), false);
    for (size_t i = 0; i < model.materials.size(); ++i)
        for_each_texture_use(model.materials[i], [&](const TextureUse& use) {
            if (material_used[i]) texture_used.at(static_cast<size_t>(use.texture)) = true;
        });

    const std::vector<int> texture_target = keep_first_of_equal(model.textures, texture_used);
    for (Material& material : model.materials)
        for_each_texture_use(material,
                             [&](TextureUse& use) { use.texture = texture_target[static_cast<size_t>(use.texture)]; });
    const std::vector<int> material_target = keep_first_of_equal(model.materials, material_used);
    for (Mesh& mesh : model.meshes) mesh.material = static_cast<uint32_t>(material_target[mesh.material]);
}

} // namespace ssrlab
