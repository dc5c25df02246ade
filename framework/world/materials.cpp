#include "world/materials.h"

namespace ssrlab {
namespace {

/// shaders/layout/material.glsl, scalar layout.
struct MaterialBlock {
    glm::vec4  base_colour;
    glm::vec3  emissive;
    float      metallic;
    float      roughness;
    float      dielectric_f0;
    float      normal_scale;
    float      alpha_cutoff;
    int32_t    double_sided;
    glm::ivec4 texture;
    glm::ivec4 uv_set;
    glm::mat3  uv_transform[textures_per_material];
};
static_assert(sizeof(MaterialBlock) == 228);

MaterialBlock to_block(const Material& material)
{
    MaterialBlock block{material.base_colour,
                        material.emissive,
                        material.metallic,
                        material.roughness,
                        material.dielectric_f0,
                        material.normal_scale,
                        material.alpha_mask ? material.alpha_cutoff : -1.0F,
                        material.double_sided,
                        {},
                        {},
                        {}};
    const auto    uses = texture_uses(material);
    for (size_t i = 0; i < uses.size(); ++i) {
        const auto use          = static_cast<glm::length_t>(i);
        block.texture[use]      = uses[i]->texture;
        block.uv_set[use]       = uses[i]->uv_set;
        block.uv_transform[use] = uses[i]->uv_transform;
    }
    return block;
}

} // namespace

std::array<const TextureUse*, textures_per_material> texture_uses(const Material& material)
{
    return {&material.base_colour_texture, &material.metallic_roughness_texture, &material.normal_texture,
            &material.emissive_texture};
}

Buffer upload_materials(Gpu& gpu, std::span<const Material> materials)
{
    std::vector<MaterialBlock> blocks;
    for (const Material& material : materials) blocks.push_back(to_block(material));
    return make_buffer_with<MaterialBlock>(gpu, blocks);
}

} // namespace ssrlab
