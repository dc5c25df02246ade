#include "scene/gltf_json.h"

#include <algorithm>
#include <cstring>

namespace ssrlab::gltf {
using nlohmann::json;
namespace {

struct ExtensionRule {
    std::string_view name, advice;
};
constexpr std::string_view decompress         = "decompress the meshes first, e.g. by gltf-transform copy";
constexpr ExtensionRule    fatal_extensions[] = {
       {"KHR_draco_mesh_compression", decompress},
       {"EXT_meshopt_compression", decompress},
       {"KHR_meshopt_compression", decompress},
       {"KHR_texture_basisu", "convert the textures to PNG or JPEG first"},
       {"EXT_texture_webp", "convert the textures to PNG or JPEG first"},
       {"EXT_texture_avif", "convert the textures to PNG or JPEG first"},
       {"MSFT_texture_dds", "convert the textures to PNG or JPEG first"},
};

// What of them is not shown has a warning of its own. Compressed copies are ignored where there are plain ones.
constexpr std::string_view supported_extensions[] = {
    "KHR_lights_punctual",     "KHR_texture_transform",      "KHR_materials_emissive_strength",
    "KHR_materials_unlit",     "KHR_mesh_quantization",      "KHR_materials_ior",
    "KHR_materials_specular",  "KHR_materials_clearcoat",    "KHR_materials_pbrSpecularGlossiness",
    "KHR_node_visibility",     "EXT_mesh_gpu_instancing",    "KHR_materials_transmission",
    "EXT_meshopt_compression", "KHR_draco_mesh_compression", "KHR_meshopt_compression"};

bool is_supported(const std::string& name)
{
    return std::ranges::find(supported_extensions, name) != std::end(supported_extensions);
}

const ExtensionRule* fatal_rule(std::string_view name)
{
    const auto* found = std::ranges::find(fatal_extensions, name, &ExtensionRule::name);
    return found == std::end(fatal_extensions) ? nullptr : found;
}

std::vector<std::string> names_in(const Import& import, const json& root, const char* key)
{
    std::vector<std::string> result;
    for (const json& name : array_of(import, root, key))
        if (name.is_string()) result.push_back(name);
    return result;
}

const json* member(const json& object, const std::string& key)
{
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
}

[[noreturn]] void refuse_compressed(const Import& import, const std::string& where, std::string_view extension)
{
    throw_spec_error("{}: {} is compressed by {}, and the file has no other copy: {}", import.file, where, extension,
                     decompress);
}

bool has_data(const Import& import, const json& root, const json& number)
{
    const json& accessors = array_of(import, root, "accessors");
    if (!number.is_number_unsigned() || number >= accessors.size()) return true; // another mistake, told elsewhere
    const json& accessor = accessors[number.get<size_t>()];
    return accessor.contains("bufferView") || accessor.contains("sparse");
}

} // namespace

const json& array_of(const Import& import, const json& object, const char* name)
{
    static const json empty = json::array();
    const auto        found = object.find(name);
    if (found == object.end()) return empty;
    if (!found->is_array()) import.fail("/{} is no array", name);
    if (found->size() > max_objects)
        import.fail("/{} has {} items, at most {} can be loaded", name, found->size(), max_objects);
    for (size_t i = 0; i < found->size(); ++i)
        if (!(*found)[i].is_object() && std::strncmp(name, "extensions", 10) != 0)
            import.fail("/{}/{} is no object", name, i);
    return *found;
}

void check_extensions(Import& import, const json& root)
{
    for (const std::string& name : names_in(import, root, "extensionsRequired")) {
        if (const ExtensionRule* rule = fatal_rule(name))
            throw_spec_error("{}: needs the extension {}, which is not supported: {}", import.file, name, rule->advice);
        if (!name.starts_with("KHR_materials_") && !is_supported(name))
            throw_spec_error("{}: needs the extension {}, which is not supported", import.file, name);
    }
    for (const std::string& name : names_in(import, root, "extensionsUsed"))
        if (!is_supported(name)) import.warn(fmt::format("extension {} is not supported and was ignored", name));
}

void check_compressed_meshes(const Import& import, const json& root)
{
    const json& buffers = array_of(import, root, "buffers");
    for (size_t i = 0; i < buffers.size(); ++i)
        for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
            const json* extensions = member(buffers[i], "extensions");
            const json* extension  = extensions != nullptr ? member(*extensions, name) : nullptr;
            if (extension != nullptr && !buffers[i].contains("uri"))
                refuse_compressed(import, fmt::format("/buffers/{}", i), name);
        }
    const json& meshes = array_of(import, root, "meshes");
    for (size_t m = 0; m < meshes.size(); ++m) {
        const json* primitives = member(meshes[m], "primitives");
        for (size_t p = 0; primitives != nullptr && primitives->is_array() && p < primitives->size(); ++p) {
            const json& primitive  = (*primitives)[p];
            const json* extensions = member(primitive, "extensions");
            if (extensions == nullptr || member(*extensions, "KHR_draco_mesh_compression") == nullptr) continue;
            const json* attributes = member(primitive, "attributes");
            const json* positions  = attributes != nullptr ? member(*attributes, "POSITION") : nullptr;
            const json* indices    = member(primitive, "indices");
            if ((positions != nullptr && !has_data(import, root, *positions)) ||
                (indices != nullptr && !has_data(import, root, *indices)))
                refuse_compressed(import, fmt::format("/meshes/{}/primitives/{}", m, p), "KHR_draco_mesh_compression");
        }
    }
}

} // namespace ssrlab::gltf
