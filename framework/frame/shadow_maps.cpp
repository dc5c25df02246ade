// One standard-depth map per directional or spot light, six per point light, drawn once per scene.
#include "frame/gpu_scene.h"

#include "core/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// The four texels of a light (shaders/gbuffer/lighting.glsl).
struct LightBlock {
    glm::vec3 position_ws;
    int32_t   type;
    glm::vec3 direction_ws;
    float     range_m;
    glm::vec3 intensity;
    int32_t   shadow_layer;
    float     cos_inner;
    float     cos_outer;
    glm::vec2 unused{0};
};
static_assert(sizeof(LightBlock) == 64);

constexpr int shadow_map_px = 2048;

struct Bounds {
    glm::dvec3 min{0}, max{0};
    glm::dvec3 centre() const { return 0.5 * (min + max); }
    double     radius() const { return std::max(0.5 * glm::length(max - min), 1e-6); }
};

Bounds bounds_of(const Scene& scene)
{
    if (scene.vertices.empty()) return {};
    Bounds bounds{glm::dvec3(scene.vertices[0].position_ws), glm::dvec3(scene.vertices[0].position_ws)};
    for (const Vertex& vertex : scene.vertices) {
        bounds.min = glm::min(bounds.min, glm::dvec3(vertex.position_ws));
        bounds.max = glm::max(bounds.max, glm::dvec3(vertex.position_ws));
    }
    return bounds;
}

glm::dvec3 any_up(glm::dvec3 direction)
{
    return std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
}

glm::dmat4 directional_matrix(const Light& light, const Bounds& bounds)
{
    const glm::dvec3 direction = glm::normalize(glm::dvec3(light.direction_ws));
    const double     radius    = bounds.radius();
    const glm::dvec3 eye       = bounds.centre() - 1.01 * radius * direction;
    return glm::orthoRH_ZO(-radius, radius, -radius, radius, 0.0, 2.02 * radius) *
           glm::lookAtRH(eye, bounds.centre(), any_up(direction));
}

glm::dmat4 perspective_matrix(const Light& light, glm::dvec3 direction, double angle_rad, const Bounds& bounds)
{
    const glm::dvec3 eye = light.position_ws;
    const double     far = std::max(glm::length(eye - bounds.centre()) + bounds.radius(), 0.1);
    return glm::perspectiveRH_ZO(angle_rad, 1.0, far * 1e-3, far) *
           glm::lookAtRH(eye, eye + direction, any_up(direction));
}

std::vector<glm::dmat4> light_matrices(const Light& light, const Bounds& bounds)
{
    if (light.type == LightType::directional) return {directional_matrix(light, bounds)};
    if (light.type == LightType::spot) {
        const double angle = std::min(2.0 * static_cast<double>(light.outer_angle_rad) + 0.05, 3.0);
        return {perspective_matrix(light, glm::normalize(glm::dvec3(light.direction_ws)), angle, bounds)};
    }
    std::vector<glm::dmat4> faces;
    // A little more than 90 degrees, so that filtering at a face's border stays inside the map.
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0),
                                   glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)})
        faces.push_back(perspective_matrix(light, axis, 1.575, bounds));
    return faces;
}

void draw_layer(Gpu& gpu, const GpuScene& scene, const DrawPipeline& pipeline, vk::DescriptorSet set, uint32_t layer,
                const glm::dmat4& world_to_clip)
{
    const vk::raii::ImageView view(
        gpu.impl->device,
        vk::ImageViewCreateInfo{.image            = *scene.shadow_map.image,
                                .viewType         = vk::ImageViewType::e2D,
                                .format           = vk::Format::eD32Sfloat,
                                .subresourceRange = {vk::ImageAspectFlagBits::eDepth, 0, 1, layer, 1}});
    const vk::Extent2D extent{static_cast<uint32_t>(scene.shadow_map.size_px.x),
                              static_cast<uint32_t>(scene.shadow_map.size_px.y)};
    submit(gpu, [&](const Commands& commands) {
        const vk::RenderingAttachmentInfo depth{.imageView   = *view,
                                                .imageLayout = vk::ImageLayout::eGeneral,
                                                .loadOp      = vk::AttachmentLoadOp::eClear,
                                                .storeOp     = vk::AttachmentStoreOp::eStore,
                                                .clearValue  = vk::ClearDepthStencilValue{1.0F, 0}};
        barrier(commands);
        commands.beginRendering({.renderArea = {{0, 0}, extent}, .layerCount = 1, .pDepthAttachment = &depth});
        commands.setViewport(
            0, vk::Viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1});
        commands.setScissor(0, vk::Rect2D{{0, 0}, extent});
        draw_scene(commands, scene, pipeline, set, world_to_clip);
        commands.endRendering();
        barrier(commands);
    });
}

GpuImage make_shadow_map(Gpu& gpu, size_t layers, const std::string& scene)
{
    const auto refuse = [&](const std::string& why) {
        throw_failure(
            "{}: its lights need {} shadow maps, {} MiB, which the device cannot hold ({}); six for each point "
            "light, one for each other; a recipe may say shadow = false",
            scene, layers, layers * shadow_map_px * shadow_map_px * sizeof(float) >> 20, why);
    };
    const size_t most = gpu.impl->limits.maxImageArrayLayers;
    if (layers > most) refuse(fmt::format("at most {}", most));
    try {
        return make_image(gpu,
                          {.format  = vk::Format::eD32Sfloat,
                           .size_px = layers == 0 ? glm::ivec2(1) : glm::ivec2(shadow_map_px),
                           .usage  = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled,
                           .layers = static_cast<uint32_t>(std::max<size_t>(layers, 1)),
                           .array_view = true});
    } catch (const std::exception& error) {
        refuse(error.what());
        throw;
    }
}

struct ShadowBlocks {
    std::vector<LightBlock> lights;
    std::vector<glm::dmat4> matrices; // a layer each
    std::vector<glm::mat4>  stored;
};

ShadowBlocks shadow_blocks(const Scene& source)
{
    const Bounds bounds = bounds_of(source);
    ShadowBlocks blocks;
    for (const Light& light : source.lights) {
        const auto own =
            light.casts_shadow && !source.draws.empty() ? light_matrices(light, bounds) : std::vector<glm::dmat4>{};
        const int layer = own.empty() ? -1 : static_cast<int>(blocks.matrices.size());
        blocks.lights.push_back({light.position_ws,
                                 static_cast<int32_t>(light.type),
                                 light.direction_ws,
                                 light.range_m,
                                 light.intensity,
                                 layer,
                                 std::cos(light.inner_angle_rad),
                                 std::cos(light.outer_angle_rad),
                                 {}});
        blocks.matrices.insert(blocks.matrices.end(), own.begin(), own.end());
    }
    if (blocks.lights.empty()) blocks.lights.push_back(LightBlock{}); // dark: no buffer is empty
    // Vulkan clip space: y points down.
    const glm::dmat4 flip = glm::scale(glm::dmat4(1.0), glm::dvec3(1, -1, 1));
    for (glm::dmat4& matrix : blocks.matrices) blocks.stored.emplace_back(matrix = flip * matrix);
    return blocks;
}

template <typename T> Buffer make_texels_with(Gpu& gpu, std::span<const T> values)
{
    Buffer buffer = make_texel_buffer(gpu, std::max(values.size_bytes(), sizeof(T)), vk::Format::eR32G32B32A32Uint);
    upload(gpu, buffer, values.data(), values.size_bytes());
    return buffer;
}

} // namespace

void make_shadow_maps(Gpu& gpu, GpuScene& scene, const Scene& source)
{
    const ShadowBlocks blocks = shadow_blocks(source);
    scene.lights              = make_texels_with<LightBlock>(gpu, blocks.lights);
    scene.shadow_matrices     = make_texels_with<glm::mat4>(gpu, blocks.stored);
    scene.shadow_map          = make_shadow_map(gpu, blocks.matrices.size(), source.name);
    scene.shadow_sampler      = {gpu.impl->device,
                                 vk::SamplerCreateInfo{.magFilter     = vk::Filter::eLinear,
                                                       .minFilter     = vk::Filter::eLinear,
                                                       .addressModeU  = vk::SamplerAddressMode::eClampToEdge,
                                                       .addressModeV  = vk::SamplerAddressMode::eClampToEdge,
                                                       .compareEnable = true,
                                                       .compareOp     = vk::CompareOp::eLessOrEqual}};
}

void render_shadow_maps(Gpu& gpu, GpuScene& scene, const Scene& source)
{
    const ShadowBlocks blocks = shadow_blocks(source);
    if (blocks.matrices.empty()) return;
    upload(gpu, scene.lights, blocks.lights.data(), blocks.lights.size() * sizeof(LightBlock));
    upload(gpu, scene.shadow_matrices, blocks.stored.data(), blocks.stored.size() * sizeof(glm::mat4));
    if (!scene.shadow_pipeline)
        scene.shadow_pipeline =
            std::make_shared<const DrawPipeline>(make_draw_pipeline(gpu, scene,
                                                                    {.fragment_shader = "gbuffer/shadow.frag",
                                                                     .colour_formats  = {},
                                                                     .reversed_depth  = false,
                                                                     .depth_alone     = true}));
    // The shadow shaders read nothing of the frame's uniforms; any buffer satisfies the layout.
    const FrameSet set = make_frame_set(gpu, scene, scene.lights);
    for (uint32_t layer = 0; layer < blocks.matrices.size(); ++layer)
        draw_layer(gpu, scene, *scene.shadow_pipeline, *set.set, layer, blocks.matrices[layer]);
}

} // namespace ssrlab
