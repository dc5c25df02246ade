// Models in any format that assimp reads; for OBJ and MTL above all.
#include "core/error.h"
#include "core/files.h"
#include "scene/image_file.h"
#include "scene/load_scene.h"
#include "scene/mesh_repair.h"
#include "scene/shapes.h"

#include <assimp/config.h>
#include <assimp/Importer.hpp>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <sstream>

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

/// -1 when the image cannot be used.
int texture_number(Import& import, std::string name)
{
    std::ranges::replace(name, '\\', '/');
    const auto [found, added] = import.texture_numbers.try_emplace(name, -1);
    if (!added) return found->second;
    try {
        const fs::path file    = import.file.parent_path() / name;
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

Material convert_material(Import& import, const aiMaterial& source)
{
    Material  material = make_material("", glm::vec3(0.8F), 0, 0.9F);
    aiString  name;
    aiColor3D diffuse(0.8F, 0.8F, 0.8F);
    aiColor3D specular(0, 0, 0);
    aiColor3D emissive(0, 0, 0);
    float     exponent = 0;
    source.Get(AI_MATKEY_NAME, name);
    source.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
    source.Get(AI_MATKEY_COLOR_SPECULAR, specular);
    source.Get(AI_MATKEY_COLOR_EMISSIVE, emissive);
    source.Get(AI_MATKEY_SHININESS, exponent);
    material.name         = name.C_Str();
    material.double_sided = true; // these formats know no front, and their models are often open sheets
    material.base_colour  = {diffuse.r, diffuse.g, diffuse.b, 1};
    material.emissive     = {emissive.r, emissive.g, emissive.b};
    // Many files carry an exponent although the material has no highlight at all.
    const bool shiny   = std::max({specular.r, specular.g, specular.b}) > 0.01F;
    material.roughness = shiny ? exponent_to_roughness(exponent) : 0.9F;
    aiString texture;
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS) {
        material.base_colour_texture.texture = texture_number(import, texture.C_Str());
        // Kd beside a texture is often black or grey by accident of the exporter; the picture is the colour.
        if (material.base_colour_texture.texture >= 0) {
            material.base_colour = glm::vec4(1);
            const Texture& used  = import.model.textures[static_cast<size_t>(material.base_colour_texture.texture)];
            material.alpha_mask  = mean_alpha(used) < 0.999F;
        }
    }
    return material;
}

/// Transparent surfaces cannot be in a G-buffer: less than half opaque is left out, the rest is drawn opaque.
bool left_out(Import& import, const aiMaterial& source, const Material& material)
{
    float opacity = 1;
    source.Get(AI_MATKEY_OPACITY, opacity);
    if (opacity >= 1) return false;
    const bool out = opacity < 0.5F;
    warn(import, fmt::format("material '{}' is {:.0f} % opaque: {}", material.name, 100 * opacity,
                             out ? "left out" : "drawn opaque"));
    return out;
}

Mesh convert_mesh(const aiMesh& source)
{
    Mesh mesh;
    mesh.name        = source.mName.C_Str();
    mesh.has_normals = source.HasNormals();
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        Vertex vertex{};
        vertex.normal_ws = {0, 1, 0};
        vertex.colour    = glm::vec4(1);
        if (mesh.has_normals) vertex.normal_ws = {source.mNormals[i].x, source.mNormals[i].y, source.mNormals[i].z};
        if (source.HasTextureCoords(0))
            // OBJ counts v from the bottom of the image.
            vertex.uv0 = vertex.uv1 = {source.mTextureCoords[0][i].x, 1 - source.mTextureCoords[0][i].y};
        mesh.positions_ws.emplace_back(source.mVertices[i].x, source.mVertices[i].y, source.mVertices[i].z);
        mesh.vertices.push_back(vertex);
    }
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices != 3) continue; // points and lines
        if (std::any_of(face.mIndices, face.mIndices + 3, [&](unsigned index) { return index >= source.mNumVertices; }))
            throw_failure("vertex index out of range in mesh '{}'", mesh.name);
        mesh.indices.insert(mesh.indices.end(), face.mIndices, face.mIndices + 3);
    }
    return mesh;
}

glm::dmat4 convert_matrix(const aiMatrix4x4& m)
{
    return {{m.a1, m.b1, m.c1, m.d1}, {m.a2, m.b2, m.c2, m.d2}, {m.a3, m.b3, m.c3, m.d3}, {m.a4, m.b4, m.c4, m.d4}};
}

/// One mesh per material: exporters cut models into hundreds of pieces.
void add_nodes(Import& import, const aiScene& scene)
{
    std::vector<std::pair<const aiNode*, glm::dmat4>> pending{{scene.mRootNode, glm::dmat4(1)}};
    while (!pending.empty()) {
        const auto [node, parent] = pending.back();
        const glm::dmat4 to_world = parent * convert_matrix(node->mTransformation);
        pending.pop_back();
        for (unsigned i = 0; i < node->mNumMeshes; ++i) {
            const aiMesh& source = *scene.mMeshes[node->mMeshes[i]];
            Mesh          mesh   = convert_mesh(source);
            transform(mesh, to_world);
            import.dropped_triangles += drop_bad_triangles(mesh);
            weld_equal_vertices(mesh);
            if (mesh.has_normals)
                turn_fronts_to_normals(mesh);
            else
                make_smooth_normals(mesh, crease_deg);
            append(import.model.meshes.at(source.mMaterialIndex), mesh);
        }
        for (unsigned i = 0; i < node->mNumChildren; ++i) pending.emplace_back(node->mChildren[i], to_world);
    }
}

/// Meshes start as one per material, so that both have the same numbers.
void add_materials(Import& import, const aiScene& scene)
{
    for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
        Mesh mesh;
        mesh.material = i;
        import.model.materials.push_back(convert_material(import, *scene.mMaterials[i]));
        mesh.name = import.model.materials.back().name;
        import.model.meshes.push_back(std::move(mesh));
    }
}

void remove_transparent(Import& import, const aiScene& scene)
{
    for (Mesh& mesh : import.model.meshes)
        if (!mesh.indices.empty() &&
            left_out(import, *scene.mMaterials[mesh.material], import.model.materials[mesh.material]))
            mesh.indices.clear();
    std::erase_if(import.model.meshes, [](const Mesh& mesh) { return mesh.indices.empty(); });
}

/// Before assimp 5.2.5, which ends with a crash where a material file says something of a material before it names one.
void check_material_file(const fs::path& file)
{
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    std::istringstream text(read_file(file));
    int                number = 1;
    for (std::string line; std::getline(text, line); ++number) {
        const size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos) continue;
        if (line.compare(first, 6, "newmtl") == 0) return;
        if (std::strchr("KkTtDdNnMmBbRrIiAaPp", line[first]) != nullptr)
            throw_failure("{}:{}: expected 'newmtl' before what is said of a material, got '{}'", file.string(), number,
                          line.substr(first, 80));
    }
}

/// Those that an OBJ file names (assimp takes one for OBJ by its content, too), and that beside it which it takes where there is no such file.
void check_material_files(const fs::path& file, std::string_view obj)
{
    constexpr std::string_view key = "mtllib";
    for (size_t at = obj.find(key); at != std::string_view::npos; at = obj.find(key, at + 1)) {
        std::string name(obj.substr(at + key.size(), obj.find('\n', at) - at - key.size()));
        while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back())) != 0) name.pop_back();
        name.erase(0, name.find_first_not_of(" \t"));
        check_material_file(file.parent_path() / name);
        check_material_file(fs::path(file).replace_extension(".mtl"));
    }
}

} // namespace

Model import_model(const fs::path& file)
{
    Import import;
    import.file                            = file;
    const std::vector<unsigned char> bytes = read_regular_file(file, 2ULL << 30); // a clear message, before assimp's
    check_material_files(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_LIGHTS | aiComponent_CAMERAS);
    // Never aiProcess_JoinIdenticalVertices: version 5.2.5 crashes in it on real files.
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_RemoveComponent);
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw_failure("{}: cannot be read: {}", file.string(), importer.GetErrorString());
    add_materials(import, *scene);
    add_nodes(import, *scene);
    remove_transparent(import, *scene);
    if (import.model.meshes.empty()) throw_failure("{}: no triangle that can be drawn", file.string());
    if (import.dropped_triangles > 0) warn(import, dropped_triangles_text(import.dropped_triangles));
    return std::move(import.model);
}

} // namespace ssrlab
