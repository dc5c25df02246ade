#include "scene/gltf.h"
#include "scene/image_file.h"
#include "scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ssrlab::gltf {
namespace {

/// A texture with its colour space: one glTF texture may be read both ways.
using TextureKey = std::pair<int, bool>;

struct Textures {
    std::map<TextureKey, int> numbers;
    std::map<int, Texture>    decoded; // by image
};

Wrap to_wrap(int wrap)
{
    if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
    return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
}

void apply_sampler(const Import& import, int sampler_index, Texture& texture)
{
    if (sampler_index < 0 || static_cast<size_t>(sampler_index) >= import.json.samplers.size()) return;
    const tinygltf::Sampler& sampler = import.json.samplers[static_cast<size_t>(sampler_index)];
    texture.wrap_u                   = to_wrap(sampler.wrapS);
    texture.wrap_v                   = to_wrap(sampler.wrapT);
    texture.nearest                  = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    texture.mipmaps =
        sampler.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST && sampler.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
}

/// An image that cannot be decoded leaves its texture out, with a warning: the shape is still worth seeing.
const Texture& decoded_image(Import& import, Textures& textures, int image_index)
{
    const auto [found, added] = textures.decoded.try_emplace(image_index);
    if (!added) return found->second;
    const std::string where = fmt::format("/images/{}", image_index);
    if (image_index < 0 || static_cast<size_t>(image_index) >= import.json.images.size()) {
        import.warn(fmt::format("{}: there is no such image; texture left out", where));
        return found->second;
    }
    const tinygltf::Image& image = import.json.images[static_cast<size_t>(image_index)];
    if (image.image.empty()) {
        import.warn(fmt::format("{} '{}' is missing; texture left out", where, image.uri.substr(0, 100)));
        return found->second;
    }
    try {
        const std::string name = image.uri.empty() ? image.name : image.uri.substr(0, 100);
        found->second          = decode_image(image.image, fmt::format("{} '{}'", where, name));
    } catch (const SpecError& error) {
        throw_spec_error("{}: {}", import.file, error.what());
    } catch (const Failure& failure) {
        import.warn(fmt::format("texture left out: {}", failure.what()));
    }
    return found->second;
}

/// The number in Model::textures, or -1.
int texture_number(Import& import, Textures& textures, int texture_index, bool srgb, const std::string& where)
{
    if (texture_index < 0) return -1;
    if (static_cast<size_t>(texture_index) >= import.json.textures.size())
        import.fail("{}: there is no texture {}", where, texture_index);
    const auto [found, added] = textures.numbers.try_emplace({texture_index, srgb}, -1);
    if (!added) return found->second;
    const tinygltf::Texture& source = import.json.textures[static_cast<size_t>(texture_index)];
    if (source.source < 0) {
        import.warn(fmt::format("/textures/{} names no PNG or JPEG image; texture left out", texture_index));
        return -1;
    }
    Texture texture = decoded_image(import, textures, source.source);
    if (texture.rgba.empty()) return -1;
    texture.srgb = srgb;
    apply_sampler(import, source.sampler, texture);
    found->second = static_cast<int>(import.model.textures.size());
    import.model.textures.push_back(std::move(texture));
    return found->second;
}

double number_in(const tinygltf::Value& value, const char* key, double fallback)
{
    return value.IsObject() && value.Has(key) && value.Get(key).IsNumber() ? value.Get(key).GetNumberAsDouble()
                                                                           : fallback;
}

glm::dvec2 pair_in(const tinygltf::Value& value, const char* key, glm::dvec2 fallback)
{
    if (!value.IsObject() || !value.Has(key)) return fallback;
    const tinygltf::Value& pair = value.Get(key);
    if (!pair.IsArray() || pair.ArrayLen() != 2 || !pair.Get(0).IsNumber() || !pair.Get(1).IsNumber()) return fallback;
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

/// KHR_texture_transform: translation * rotation * scale.
glm::mat3 uv_transform_of(const tinygltf::Value& extension)
{
    const glm::dvec2 offset   = pair_in(extension, "offset", {0, 0});
    const glm::dvec2 scale    = pair_in(extension, "scale", {1, 1});
    const double     rotation = number_in(extension, "rotation", 0);
    const double     c        = std::cos(rotation);
    const double     s        = std::sin(rotation);
    return glm::mat3(glm::dmat3({c * scale.x, -s * scale.x, 0}, {s * scale.y, c * scale.y, 0}, {offset, 1}));
}

template <typename Info>
TextureUse texture_use(Import& import, Textures& textures, const Info& info, bool srgb, const std::string& where)
{
    TextureUse use;
    use.texture          = texture_number(import, textures, info.index, srgb, where);
    use.uv_set           = info.texCoord;
    const auto extension = info.extensions.find("KHR_texture_transform");
    if (extension != info.extensions.end()) {
        use.uv_transform = uv_transform_of(extension->second);
        use.uv_set = static_cast<int>(std::clamp(number_in(extension->second, "texCoord", use.uv_set), -1.0, 2.0));
    }
    if (use.texture >= 0 && (use.uv_set < 0 || use.uv_set > 1)) {
        import.warn(fmt::format("{}: texture coordinate set {} is not supported; texture left out", where, use.uv_set));
        return {};
    }
    return use;
}

float unit_range(double value, float fallback)
{
    return std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : fallback;
}

/// KHR_materials_ior and KHR_materials_specular: one number, reflectance at normal incidence.
float dielectric_f0_of(Import& import, const tinygltf::Material& source, const std::string& where)
{
    float      f0  = common_dielectric_f0;
    const auto ior = source.extensions.find("KHR_materials_ior");
    if (ior != source.extensions.end()) {
        const double index = number_in(ior->second, "ior", 1.5);
        f0                 = index == 0 ? 1.0F : ior_to_f0(std::clamp(index, 1.0, 10.0)); // 0 means: all is reflected
    }
    const auto specular = source.extensions.find("KHR_materials_specular");
    if (specular == source.extensions.end()) return f0;
    const tinygltf::Value& values = specular->second;
    double                 colour = 1;
    if (values.Has("specularColorFactor") && values.Get("specularColorFactor").IsArray()) {
        const tinygltf::Value& factors = values.Get("specularColorFactor");
        std::vector<double>    numbers;
        for (size_t c = 0; c < factors.ArrayLen(); ++c)
            if (factors.Get(int(c)).IsNumber()) numbers.push_back(factors.Get(int(c)).GetNumberAsDouble());
        colour = numbers.empty() ? 1 : std::ranges::max(numbers);
        if (!numbers.empty() && std::ranges::min(numbers) != colour)
            import.warn(fmt::format(
                "{}: the colour of KHR_materials_specular is not supported; its largest part counts", where));
    }
    if (values.Has("specularTexture") || values.Has("specularColorTexture"))
        import.warn(fmt::format("{}: textures of KHR_materials_specular are not supported; factors count", where));
    return unit_range(std::min(static_cast<double>(f0) * std::max(colour, 0.0), 1.0) *
                          std::clamp(number_in(values, "specularFactor", 1), 0.0, 1.0),
                      f0);
}

/// KHR_materials_clearcoat: a pixel has one lobe. The coat's replaces that of what is not metal; a metal keeps its own.
void add_clearcoat(Import& import, const tinygltf::Material& source, const std::string& where, Material& material)
{
    const auto coat = source.extensions.find("KHR_materials_clearcoat");
    if (coat == source.extensions.end()) return;
    const auto factor = unit_range(number_in(coat->second, "clearcoatFactor", 0), 0);
    if (factor == 0) return;
    if (material.metallic > 0.5F) {
        import.warn(fmt::format("{}: clear coat over metal is not supported; coat left out", where));
        return;
    }
    for (const char* texture : {"clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture"})
        if (coat->second.Has(texture))
            import.warn(fmt::format("{}: textures of KHR_materials_clearcoat are not supported; factors count", where));
    const auto roughness = unit_range(number_in(coat->second, "clearcoatRoughnessFactor", 0), 0);
    material.roughness += (roughness - material.roughness) * factor;
    material.metallic_roughness_texture = {};
    material.dielectric_f0 += (common_dielectric_f0 - material.dielectric_f0) * factor;
}

glm::vec4 colour_in(const tinygltf::Value& value, const char* key, size_t components)
{
    glm::vec4 colour(1);
    if (!value.IsObject() || !value.Has(key)) return colour;
    const tinygltf::Value& factors = value.Get(key);
    if (!factors.IsArray() || factors.ArrayLen() != components) return colour;
    for (size_t c = 0; c < components; ++c)
        if (factors.Get(int(c)).IsNumber())
            colour[static_cast<int>(c)] = unit_range(factors.Get(int(c)).GetNumberAsDouble(), 1);
    return colour;
}

tinygltf::TextureInfo texture_info_in(const tinygltf::Value& value, const char* key)
{
    tinygltf::TextureInfo info;
    if (!value.IsObject() || !value.Has(key)) return info;
    const tinygltf::Value& source = value.Get(key);
    info.index                    = static_cast<int>(number_in(source, "index", -1));
    info.texCoord                 = static_cast<int>(number_in(source, "texCoord", 0));
    if (source.IsObject() && source.Has("extensions") && source.Get("extensions").IsObject())
        for (const std::string& name : source.Get("extensions").Keys())
            info.extensions[name] = source.Get("extensions").Get(name);
    return info;
}

void add_specular_glossiness(Import& import, Textures& textures, const tinygltf::Material& source,
                             const std::string& where, Material& material)
{
    const auto found = source.extensions.find("KHR_materials_pbrSpecularGlossiness");
    if (found == source.extensions.end()) return;
    const tinygltf::Value&   values = found->second;
    const SpecularGlossiness factors{colour_in(values, "diffuseFactor", 4),
                                     glm::vec3(colour_in(values, "specularFactor", 3)),
                                     unit_range(number_in(values, "glossinessFactor", 1), 1)};
    material.base_colour_texture =
        texture_use(import, textures, texture_info_in(values, "diffuseTexture"), true, where);
    material.metallic_roughness_texture =
        texture_use(import, textures, texture_info_in(values, "specularGlossinessTexture"), true, where);
    const TextureUse diffuse = material.base_colour_texture, gloss = material.metallic_roughness_texture;
    set_factors(material, factors);
    if (gloss.texture < 0) return;
    if (diffuse.texture >= 0 && (diffuse.uv_set != gloss.uv_set || diffuse.uv_transform != gloss.uv_transform)) {
        import.warn(fmt::format("{}: the textures of diffuse and specular colour lie differently: drawn matt", where));
        material.metallic_roughness_texture = {};
        material.metallic                   = 0;
        material.roughness                  = 1;
        return;
    }
    auto& all = import.model.textures;
    auto [base, metal] =
        bake(diffuse.texture >= 0 ? all[size_t(diffuse.texture)] : Texture{}, all[size_t(gloss.texture)], factors);
    material.base_colour_texture                = gloss;
    material.base_colour_texture.texture        = static_cast<int>(all.size());
    material.metallic_roughness_texture.texture = static_cast<int>(all.size() + 1);
    material.base_colour                        = glm::vec4(1);
    material.metallic = material.roughness = 1;
    material.dielectric_f0                 = common_dielectric_f0;
    all.push_back(std::move(base));
    all.push_back(std::move(metal));
}

Material convert(Import& import, Textures& textures, const tinygltf::Material& source, const std::string& where)
{
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material                              material;
    material.name = source.name;
    for (int c = 0; c < 4 && pbr.baseColorFactor.size() == 4; ++c)
        material.base_colour[c] = unit_range(pbr.baseColorFactor[static_cast<size_t>(c)], 1);
    if (pbr.roughnessFactor < 0 || pbr.roughnessFactor > 1 || pbr.metallicFactor < 0 || pbr.metallicFactor > 1)
        import.warn(fmt::format("{}: metallic or roughness outside [0, 1] was clamped", where));
    if (std::ranges::any_of(source.emissiveFactor, [](double factor) { return factor < 0 || factor > 1; }))
        import.warn(fmt::format("{}: emissive factors outside [0, 1] were clamped: KHR_materials_emissive_strength "
                                "makes surfaces brighter",
                                where));
    material.metallic  = unit_range(pbr.metallicFactor, 1);
    material.roughness = unit_range(pbr.roughnessFactor, 1);
    for (int c = 0; c < 3 && source.emissiveFactor.size() == 3; ++c)
        material.emissive[c] = unit_range(source.emissiveFactor[static_cast<size_t>(c)], 0);
    const auto strength = source.extensions.find("KHR_materials_emissive_strength");
    if (strength != source.extensions.end())
        material.emissive *=
            static_cast<float>(std::clamp(number_in(strength->second, "emissiveStrength", 1), 0.0, 1e6));
    material.emissive = glm::min(material.emissive, largest_radiance);
    material.normal_scale =
        std::isfinite(source.normalTexture.scale) ? static_cast<float>(source.normalTexture.scale) : 1.0F;
    material.double_sided = source.doubleSided;
    material.alpha_mask   = source.alphaMode == "MASK";
    // Above 1 nothing is drawn, glTF 2.0, 3.9.4.
    material.alpha_cutoff =
        std::isfinite(source.alphaCutoff) ? static_cast<float>(std::max(source.alphaCutoff, 0.0)) : 0.5F;
    material.base_colour_texture        = texture_use(import, textures, pbr.baseColorTexture, true, where);
    material.metallic_roughness_texture = texture_use(import, textures, pbr.metallicRoughnessTexture, false, where);
    material.normal_texture             = texture_use(import, textures, source.normalTexture, false, where);
    material.emissive_texture           = texture_use(import, textures, source.emissiveTexture, true, where);
    if (source.extensions.contains("KHR_materials_unlit")) {
        // Unlit shows its base colour whatever the light: that is emission and nothing else.
        material.emissive                   = glm::vec3(material.base_colour);
        material.emissive_texture           = material.base_colour_texture;
        material.base_colour                = {0, 0, 0, material.base_colour.a};
        material.metallic                   = 0;
        material.roughness                  = 1;
        material.dielectric_f0              = 0;
        material.metallic_roughness_texture = {};
        return material;
    }
    if (source.occlusionTexture.index >= 0)
        import.warn("occlusion textures are not supported: ambient light reaches all of a surface");
    material.dielectric_f0 = dielectric_f0_of(import, source, where);
    add_clearcoat(import, source, where, material);
    add_specular_glossiness(import, textures, source, where, material);
    return material;
}

/// A G-buffer holds opaque surfaces only. On average less than half opaque: left out. Otherwise drawn, where alpha >= 0.5.
bool transparent(Import& import, const tinygltf::Material& source, Material& material)
{
    if (source.extensions.contains("KHR_materials_transmission"))
        import.warn(fmt::format("material '{}' transmits light: drawn opaque", source.name));
    if (source.alphaMode != "BLEND") return false;
    float alpha = material.base_colour.a;
    if (material.base_colour_texture.texture >= 0)
        alpha *= mean_alpha(import.model.textures[static_cast<size_t>(material.base_colour_texture.texture)]);
    material.alpha_mask   = true;
    material.alpha_cutoff = 0.5F;
    import.warn(fmt::format("material '{}' is transparent (mean alpha {:.2f}): {}", source.name, alpha,
                            alpha < 0.5F ? "left out" : "drawn opaque where its alpha is at least 0.5"));
    return alpha < 0.5F;
}

} // namespace

std::vector<bool> add_materials(Import& import)
{
    Textures          textures;
    std::vector<bool> left_out;
    for (size_t i = 0; i < import.json.materials.size(); ++i) {
        const tinygltf::Material& source   = import.json.materials[i];
        Material                  material = convert(import, textures, source, fmt::format("/materials/{}", i));
        left_out.push_back(transparent(import, source, material));
        import.model.materials.push_back(std::move(material));
    }
    import.model.materials.push_back(make_material("default", glm::vec3(1), 1, 1));
    left_out.push_back(false);
    return left_out;
}

} // namespace ssrlab::gltf
