#include "frame/gpu_scene.h"

#include "core/error.h"
#include "scene/prefiltered_environment.h"
#include "world/materials.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

vk::SamplerAddressMode address_mode(Wrap wrap)
{
    switch (wrap) {
    case Wrap::repeat: return vk::SamplerAddressMode::eRepeat;
    case Wrap::mirrored_repeat: return vk::SamplerAddressMode::eMirroredRepeat;
    case Wrap::clamp_to_edge: return vk::SamplerAddressMode::eClampToEdge;
    }
    return vk::SamplerAddressMode::eRepeat;
}

vk::raii::Sampler make_sampler(Gpu& gpu, const Texture& texture)
{
    const auto filter = texture.nearest ? vk::Filter::eNearest : vk::Filter::eLinear;
    return {gpu.impl->device, vk::SamplerCreateInfo{.magFilter    = filter,
                                                    .minFilter    = filter,
                                                    .mipmapMode   = vk::SamplerMipmapMode::eLinear,
                                                    .addressModeU = address_mode(texture.wrap_u),
                                                    .addressModeV = address_mode(texture.wrap_v),
                                                    .maxLod       = texture.mipmaps ? VK_LOD_CLAMP_NONE : 0.0F}};
}

/// Each level is the filtered half of the one before.
void make_mipmaps(Gpu& gpu, GpuImage& image)
{
    submit(gpu, [&](const Commands& commands) {
        glm::ivec2 size = image.size_px;
        for (uint32_t level = 1; level < image.levels; ++level) {
            const glm::ivec2    half = glm::max(size / 2, glm::ivec2(1));
            const vk::ImageBlit blit{.srcSubresource = {vk::ImageAspectFlagBits::eColor, level - 1, 0, 1},
                                     .srcOffsets     = {{vk::Offset3D{0, 0, 0}, vk::Offset3D{size.x, size.y, 1}}},
                                     .dstSubresource = {vk::ImageAspectFlagBits::eColor, level, 0, 1},
                                     .dstOffsets     = {{vk::Offset3D{0, 0, 0}, vk::Offset3D{half.x, half.y, 1}}}};
            barrier(commands);
            commands.blitImage(*image.image, vk::ImageLayout::eGeneral, *image.image, vk::ImageLayout::eGeneral, blit,
                               vk::Filter::eLinear);
            size = half;
        }
        barrier(commands);
    });
}

GpuImage upload_texture(Gpu& gpu, const Texture& texture)
{
    const int      largest = std::max(texture.size_px.x, texture.size_px.y);
    const uint32_t levels  = texture.mipmaps ? static_cast<uint32_t>(std::log2(largest)) + 1 : 1;
    GpuImage image = make_image(gpu, {.format  = texture.srgb ? vk::Format::eR8G8B8A8Srgb : vk::Format::eR8G8B8A8Unorm,
                                      .size_px = texture.size_px,
                                      .usage   = vk::ImageUsageFlagBits::eSampled,
                                      .levels  = levels});
    upload(gpu, image, texture.rgba.data(), texture.rgba.size());
    if (levels > 1) make_mipmaps(gpu, image);
    return image;
}

void upload_environment(Gpu& gpu, GpuScene& scene, const Scene& source)
{
    const bool             mapped = !source.environment.radiance.empty();
    std::vector<glm::vec4> texels(mapped ? 0 : 1, glm::vec4(source.background, 1));
    for (const glm::vec3& radiance : source.environment.radiance) texels.emplace_back(radiance, 1);
    scene.environment_map =
        make_image(gpu, {.format  = vk::Format::eR32G32B32A32Sfloat,
                         .size_px = mapped ? source.environment.size_px : glm::ivec2(1),
                         .usage   = vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eSampled});
    upload(gpu, scene.environment_map, texels.data(), texels.size() * sizeof(glm::vec4));
    scene.environment = source.environment;
}

Texture white_texture()
{
    Texture texture;
    texture.size_px = {1, 1};
    texture.rgba    = {255, 255, 255, 255};
    texture.mipmaps = false;
    return texture;
}

vk::raii::DescriptorSetLayout make_layout(Gpu& gpu, std::vector<vk::DescriptorType> types)
{
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (uint32_t i = 0; i < types.size(); ++i)
        bindings.push_back({.binding         = i,
                            .descriptorType  = types[i],
                            .descriptorCount = 1,
                            .stageFlags      = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment});
    return {gpu.impl->device, vk::DescriptorSetLayoutCreateInfo{.bindingCount = static_cast<uint32_t>(bindings.size()),
                                                                .pBindings    = bindings.data()}};
}

void make_material_sets(Gpu& gpu, GpuScene& scene, const Scene& source)
{
    const auto                   count = static_cast<uint32_t>(std::max<size_t>(source.materials.size(), 1));
    const vk::DescriptorPoolSize size{vk::DescriptorType::eCombinedImageSampler, count * textures_per_material};
    scene.pool = {gpu.impl->device,
                  vk::DescriptorPoolCreateInfo{.flags         = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                               .maxSets       = count,
                                               .poolSizeCount = 1,
                                               .pPoolSizes    = &size}};
    for (const Material& material : source.materials) {
        vk::raii::DescriptorSets sets(
            gpu.impl->device,
            {.descriptorPool = *scene.pool, .descriptorSetCount = 1, .pSetLayouts = &*scene.material_layout});
        const auto uses = texture_uses(material);
        for (uint32_t i = 0; i < textures_per_material; ++i) {
            const bool   has   = uses[i]->texture >= 0;
            const size_t index = has ? static_cast<size_t>(uses[i]->texture) : scene.textures.size() - 1;
            const vk::DescriptorImageInfo image{.sampler     = *scene.samplers[index],
                                                .imageView   = *scene.textures[index].view,
                                                .imageLayout = vk::ImageLayout::eGeneral};
            gpu.impl->device.updateDescriptorSets(
                vk::WriteDescriptorSet{.dstSet          = *sets[0],
                                       .dstBinding      = i,
                                       .descriptorCount = 1,
                                       .descriptorType  = vk::DescriptorType::eCombinedImageSampler,
                                       .pImageInfo      = &image},
                nullptr);
        }
        scene.material_sets.push_back(std::move(sets[0]));
    }
}

} // namespace

GpuScenePtr upload_scene(Gpu& gpu, const Scene& source)
{
    auto scene       = std::make_shared<GpuScene>();
    scene->vertices  = make_buffer_with<Vertex>(gpu, source.vertices);
    scene->indices   = make_buffer_with<uint32_t>(gpu, source.indices);
    scene->materials = upload_materials(gpu, source.materials);
    for (const Texture& texture : source.textures) {
        scene->textures.push_back(upload_texture(gpu, texture));
        scene->samplers.push_back(make_sampler(gpu, texture));
    }
    scene->textures.push_back(upload_texture(gpu, white_texture()));
    scene->samplers.push_back(make_sampler(gpu, white_texture()));

    using Type          = vk::DescriptorType;
    const Type texels   = texel_descriptor(gpu);
    scene->frame_layout = make_layout(
        gpu, {Type::eUniformBuffer, Type::eStorageBuffer, texels, texels, Type::eCombinedImageSampler, texels});
    scene->material_layout = make_layout(gpu, std::vector<Type>(textures_per_material, Type::eCombinedImageSampler));
    make_material_sets(gpu, *scene, source);
    for (size_t i = 0; i < source.draws.size(); ++i) {
        const Draw& draw = source.draws[i];
        scene->draws.push_back({draw.first_index, draw.index_count, draw.material, static_cast<uint32_t>(i + 1),
                                source.materials[draw.material].double_sided,
                                source.materials[draw.material].alpha_mask, draw.bounds_min_ws, draw.bounds_max_ws});
    }
    scene->ambient             = source.ambient;
    scene->alpha_mask          = std::ranges::any_of(source.materials, &Material::alpha_mask);
    scene->has_environment_map = !source.environment.radiance.empty();
    upload_environment(gpu, *scene, source);
    make_shadow_maps(gpu, *scene, source);
    render_shadow_maps(gpu, *scene, source);
    return scene;
}

const GpuImage& blurred_environment(Gpu& gpu, GpuScene& scene)
{
    if (!scene.has_environment_map) return scene.environment_map;
    if (!scene.blurred_environment) {
        const EnvironmentMap   levels = prefilter_environment(scene.environment);
        std::vector<glm::vec4> texels;
        for (const glm::vec3& radiance : levels.radiance)
            texels.push_back(glm::unpackHalf4x16(glm::packHalf4x16(glm::vec4(radiance, 1))));
        scene.blurred_environment =
            make_image(gpu, {.format  = vk::Format::eR32G32B32A32Sfloat,
                             .size_px = levels.size_px,
                             .usage   = vk::ImageUsageFlagBits::eStorage | vk::ImageUsageFlagBits::eSampled});
        upload(gpu, *scene.blurred_environment, texels.data(), texels.size() * sizeof(glm::vec4));
    }
    return *scene.blurred_environment;
}

void move_scene(Gpu& gpu, GpuScene& uploaded, const Scene& moved)
{
    upload(gpu, uploaded.vertices, moved.vertices.data(), moved.vertices.size() * sizeof(Vertex));
    for (size_t i = 0; i < moved.draws.size(); ++i) {
        uploaded.draws[i].bounds_min_ws = moved.draws[i].bounds_min_ws;
        uploaded.draws[i].bounds_max_ws = moved.draws[i].bounds_max_ws;
    }
    render_shadow_maps(gpu, uploaded, moved);
}

FrameSet make_frame_set(Gpu& gpu, const GpuScene& scene, const Buffer& frame_uniforms, const DepthBuffer* first_depth)
{
    using Type                           = vk::DescriptorType;
    const vk::DescriptorPoolSize sizes[] = {{Type::eUniformBuffer, 1},
                                            {Type::eStorageBuffer, 1},
                                            {Type::eCombinedImageSampler, 1},
                                            {texel_descriptor(gpu), 3}};
    FrameSet                     result;
    result.pool = {gpu.impl->device,
                   vk::DescriptorPoolCreateInfo{.flags         = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                                .maxSets       = 1,
                                                .poolSizeCount = std::size(sizes),
                                                .pPoolSizes    = sizes}};
    vk::raii::DescriptorSets sets(
        gpu.impl->device,
        {.descriptorPool = *result.pool, .descriptorSetCount = 1, .pSetLayouts = &*scene.frame_layout});
    result.set             = std::move(sets[0]);
    const auto bind_buffer = [&](uint32_t binding, Type type, const Buffer& buffer, const vk::BufferView* texels) {
        const vk::DescriptorBufferInfo info{*buffer.buffer, 0, VK_WHOLE_SIZE};
        gpu.impl->device.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet           = *result.set,
                                                                     .dstBinding       = binding,
                                                                     .descriptorCount  = 1,
                                                                     .descriptorType   = type,
                                                                     .pBufferInfo      = &info,
                                                                     .pTexelBufferView = texels},
                                              nullptr);
    };
    bind_buffer(0, Type::eUniformBuffer, frame_uniforms, nullptr);
    bind_buffer(1, Type::eStorageBuffer, scene.materials, nullptr);
    bind_buffer(2, texel_descriptor(gpu), scene.lights, &*scene.lights.texels);
    bind_buffer(3, texel_descriptor(gpu), scene.shadow_matrices, &*scene.shadow_matrices.texels);
    const vk::DescriptorImageInfo image{*scene.shadow_sampler, *scene.shadow_map.view, vk::ImageLayout::eGeneral};
    gpu.impl->device.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet          = *result.set,
                                                                 .dstBinding      = 4,
                                                                 .descriptorCount = 1,
                                                                 .descriptorType  = Type::eCombinedImageSampler,
                                                                 .pImageInfo      = &image},
                                          nullptr);
    if (first_depth != nullptr) bind_buffer(5, texel_descriptor(gpu), first_depth->cells, &*first_depth->words);
    return result;
}

} // namespace ssrlab
