// Models in any format that assimp reads; for OBJ and MTL above all.
#include "core/error.h"
#include "core/files.h"
#include "scene/image_file.h"
#include "scene/load_scene.h"
#include "scene/mesh_repair.h"
#include "scene/model_file.h"
#include "scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

constexpr double crease_deg = 60;

struct Import {
    fs::path                   file;
    Model                      model;
    std::map<std::string, int> texture_numbers; // by the name in the material file
    size_t                     dropped_triangles = 0;
};

void warn(Import& import, const std::string& text)
{
    import.model.warnings.push_back(fmt::format("{}: {}", import.file.filename().string(), text));
}

/// The image that a material names. Where there is none at that place, which may be on another machine, it is the one of
/// the same name beside the model.
fs::path texture_file(const Import& import, std::string name)
{
    std::ranges::replace(name, '\\', '/');
    name.erase(name.find_last_not_of(" \t\r") + 1);
    const fs::path folder = import.file.parent_path(), file = folder / name,
                   beside = folder / fs::path(name).filename();
    std::error_code error;
    return !fs::exists(file, error) && fs::exists(beside, error) ? beside : file;
}

/// -1 when the image cannot be used.
int texture_number(Import& import, const std::string& name)
{
    const auto [found, added] = import.texture_numbers.try_emplace(name, -1);
    if (!added) return found->second;
    try {
        const fs::path file    = texture_file(import, name);
        Texture        texture = decode_image(read_regular_file(file, 1ULL << 30), file.string());
        texture.srgb           = true;
        found->second          = static_cast<int>(import.model.textures.size());
        import.model.textures.push_back(std::move(texture));
    } catch (const Failure& failure) {
        warn(import, fmt::format("texture left out: {}", failure.what()));
    }
    return found->second;
}

/// Phong's exponent as the roughness of a microfacet lobe of the same width (Walter et al. 2007, alpha^2 = 2 / (n + 2)).
float exponent_to_roughness(float exponent)
{
    return std::clamp(std::pow(2.0F / (std::max(exponent, 0.0F) + 2.0F), 0.25F), 0.05F, 1.0F);
}

Material convert_material(Import& import, const FileMaterial& source)
{
    Material material     = make_material(source.name, source.diffuse, 0, 0.9F);
    material.double_sided = true; // these formats know no front, and their models are often open sheets
    material.emissive     = source.emissive;
    // Many files carry an exponent although the material has no highlight at all.
    const bool shiny = std::max({source.specular.r, source.specular.g, source.specular.b}) > 0.01F;
    if (shiny) material.roughness = exponent_to_roughness(source.exponent);
    // Pr and Pm of OBJ.
    if (source.roughness >= 0) material.roughness = std::min(source.roughness, 1.0F);
    if (source.metallic >= 0) material.metallic = std::min(source.metallic, 1.0F);
    if (source.texture.empty()) return material;
    material.base_colour_texture.texture = texture_number(import, source.texture);
    // Kd beside a texture is often black or grey by accident of the exporter; the picture is the colour.
    if (material.base_colour_texture.texture >= 0) {
        material.base_colour = glm::vec4(1);
        const Texture& used  = import.model.textures[static_cast<size_t>(material.base_colour_texture.texture)];
        material.alpha_mask  = mean_alpha(used) < 0.999F;
    }
    return material;
}

/// Transparent surfaces cannot be in a G-buffer: less than half opaque is left out, the rest is drawn opaque.
bool left_out(Import& import, const FileMaterial& source)
{
    if (!(source.opacity < 1)) return false;
    const bool out = source.opacity < 0.5F;
    warn(import, fmt::format("material '{}' is {:.0f} % opaque: {}", source.name, 100 * source.opacity,
                             out ? "left out" : "drawn opaque"));
    return out;
}

/// One mesh per material, with its number: exporters cut models into hundreds of pieces.
void add_meshes(Import& import, std::vector<FileMesh> meshes)
{
    for (uint32_t i = 0; i < import.model.materials.size(); ++i) {
        Mesh& mesh    = import.model.meshes.emplace_back();
        mesh.material = i;
        mesh.name     = import.model.materials[i].name;
    }
    for (Mesh& mesh : meshes) {
        import.dropped_triangles += drop_bad_triangles(mesh);
        weld_equal_vertices(mesh);
        if (mesh.has_normals)
            turn_fronts_to_normals(mesh);
        else
            make_smooth_normals(mesh, crease_deg);
        append(import.model.meshes[mesh.material], mesh);
    }
}

void remove_transparent(Import& import, const std::vector<FileMaterial>& materials)
{
    for (Mesh& mesh : import.model.meshes)
        if (!mesh.indices.empty() && left_out(import, materials[mesh.material])) mesh.indices.clear();
    std::erase_if(import.model.meshes, [](const Mesh& mesh) { return mesh.indices.empty(); });
}

/// assimp keeps positions as floats, whatever the file says.
void warn_of_rounding(Import& import, const FileModel& source)
{
    constexpr double visible = 1e-5; // of the model's size
    Bounds           bounds;
    for (const Mesh& mesh : source.meshes)
        for (const glm::dvec3& position : mesh.positions_ws)
            if (usable(position)) bounds.add(position);
    if (bounds.empty()) return;
    const glm::dvec3 farthest = glm::max(glm::abs(bounds.min_ws), glm::abs(bounds.max_ws));
    const double     far_m    = std::max({farthest.x, farthest.y, farthest.z});
    if (far_m * 0x1p-24 > visible * glm::length(bounds.size_m()))
        warn(import, fmt::format("it lies {:.3g} units from its origin, where positions are rounded to {:.2g}: move it "
                                 "to its origin, or use a .glb with a node that places it",
                                 far_m, far_m * 0x1p-24));
}

/// The grey that assimp gives to what has no material is no factor of colours at vertices.
void colour_by_vertices(Import& import, FileModel& source)
{
    for (size_t i = 0; i < source.materials.size(); ++i) {
        const auto uses    = [&](const FileMesh& mesh) { return mesh.material == i; };
        const auto colours = [&](const FileMesh& mesh) { return uses(mesh) && mesh.has_colours; };
        if (!source.materials[i].is_default || !std::ranges::any_of(source.meshes, colours)) continue;
        const glm::vec4 grey                  = import.model.materials[i].base_colour;
        import.model.materials[i].base_colour = glm::vec4(1);
        for (FileMesh& mesh : source.meshes)
            for (Vertex& vertex : mesh.vertices)
                if (uses(mesh) && !mesh.has_colours) vertex.colour = grey;
    }
}

void warn_of_other_maps(Import& import, const FileModel& source)
{
    for (size_t i = 0; i < source.materials.size(); ++i)
        if (const FileMaterial& material = source.materials[i];
            !material.other_maps.empty() &&
            std::ranges::any_of(source.meshes, [&](const Mesh& mesh) { return mesh.material == i; }))
            warn(import,
                 fmt::format("material '{}': textures of {} are not supported for this format and left out: use "
                             "glTF for them",
                             material.name, material.other_maps));
}

} // namespace

Model import_model(const fs::path& file)
{
    Import import;
    import.file      = file;
    FileModel source = read_model_file(file);
    warn_of_rounding(import, source);
    for (const FileMaterial& material : source.materials)
        import.model.materials.push_back(convert_material(import, material));
    colour_by_vertices(import, source);
    warn_of_other_maps(import, source);
    for (const std::string& warning : source.warnings) warn(import, warning);
    add_meshes(import, std::move(source.meshes));
    remove_transparent(import, source.materials);
    if (import.model.meshes.empty())
        throw_failure("{}: no triangle that can be drawn{}", file.string(),
                      import.model.warnings.empty() ? "" : "; " + import.model.warnings.back());
    if (import.dropped_triangles > 0) warn(import, dropped_triangles_text(import.dropped_triangles));
    return std::move(import.model);
}

} // namespace ssrlab
