#include "frame/gbuffer.h"

#include "frame/solid_backs.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "core/plane_gradient.h"
#include "shared.h"
#include "trace/frame_passes.h"

#include <glm/gtc/packing.hpp>

#include <cmath>

namespace ssrlab {
namespace {

/// shaders/gbuffer/gbuffer.frag, uniform Frame, scalar layout.
struct FrameBlock {
    glm::mat4  world_to_view;
    glm::vec3  eye_ws;
    int32_t    orthographic;
    glm::vec3  view_axis_ws;
    int32_t    light_count;
    glm::vec3  ambient;
    float      layer_separation = 0;
    glm::ivec2 size_px{0, 0};
};

using HalfTexel = std::array<uint16_t, 4>;

HalfTexel to_half(glm::vec4 v)
{
    return {glm::packHalf1x16(v.x), glm::packHalf1x16(v.y), glm::packHalf1x16(v.z), glm::packHalf1x16(v.w)};
}

glm::vec4 from_half(const HalfTexel& h)
{
    return {glm::unpackHalf1x16(h[0]), glm::unpackHalf1x16(h[1]), glm::unpackHalf1x16(h[2]), glm::unpackHalf1x16(h[3])};
}

} // namespace

GBufferPtr make_gbuffer(Gpu& gpu, const View& view, Filled filled)
{
    if (view.size_px.x > MAX_IMAGE_PX || view.size_px.y > MAX_IMAGE_PX)
        throw_spec_error("image size {}x{} is outside 1x1 to {}x{}", view.size_px.x, view.size_px.y, MAX_IMAGE_PX,
                         MAX_IMAGE_PX);
    using Format     = vk::Format;
    auto gbuffer     = std::make_shared<GBuffer>();
    gbuffer->view    = view;
    const auto image = [&](Format format) {
        using Usage      = vk::ImageUsageFlagBits;
        const auto usage = filled == Filled::drawn ? Usage::eColorAttachment | Usage::eStorage : Usage::eStorage;
        return make_image(gpu, {.format = format, .size_px = view.size_px, .usage = usage});
    };
    gbuffer->depth      = make_depth_buffer(gpu, view.size_px);
    gbuffer->normal     = image(Format::eR32G32B32A32Sfloat);
    gbuffer->material   = image(Format::eR16G16B16A16Sfloat);
    gbuffer->dielectric = image(Format::eR32Sfloat);
    gbuffer->radiance   = image(Format::eR16G16B16A16Sfloat);
    gbuffer->highlight  = image(Format::eR16G16B16A16Sfloat);
    gbuffer->object     = image(Format::eR32Uint);
    gbuffer->gradient   = image(Format::eR32Uint);
    gbuffer->solid      = image(Format::eR32Sfloat);
    return gbuffer;
}

namespace {

void fill_frame_uniforms(Gpu& gpu, GBuffer& gbuffer)
{
    const glm::dmat4 view_to_world = glm::inverse(gbuffer.view.world_to_view);
    const FrameBlock block{glm::mat4(gbuffer.view.world_to_view),
                           glm::vec3(view_to_world[3]),
                           gbuffer.view.projection == Projection::orthographic,
                           glm::vec3(-view_to_world[2]),
                           static_cast<int32_t>(gbuffer.scene->light_count),
                           gbuffer.scene->ambient,
                           0,
                           gbuffer.view.size_px};
    gbuffer.frame_uniforms = make_buffer(gpu, sizeof(block));
    upload(gpu, gbuffer.frame_uniforms, &block, sizeof(block));
}

} // namespace

vk::RenderingAttachmentInfo cleared_attachment(const GpuImage& image, vk::ClearValue clear)
{
    return {.imageView   = *image.view,
            .imageLayout = vk::ImageLayout::eGeneral,
            .loadOp      = vk::AttachmentLoadOp::eClear,
            .storeOp     = vk::AttachmentStoreOp::eStore,
            .clearValue  = clear};
}

namespace {

vk::ClearValue colour(glm::vec4 c) { return vk::ClearColorValue{std::array<float, 4>{c.x, c.y, c.z, c.w}}; }

void record_rasterisation(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer)
{
    const vk::RenderingAttachmentInfo colours[] = {
        cleared_attachment(gbuffer.normal, colour(glm::vec4(0))),
        cleared_attachment(gbuffer.material, colour(glm::vec4(0))),
        cleared_attachment(gbuffer.radiance, colour(glm::vec4(0))),
        cleared_attachment(gbuffer.highlight, colour(glm::vec4(0))),
        cleared_attachment(gbuffer.object, vk::ClearColorValue{std::array<uint32_t, 4>{0, 0, 0, 0}}),
        cleared_attachment(gbuffer.gradient, vk::ClearColorValue{std::array<uint32_t, 4>{0, 0, 0, 0}}),
        cleared_attachment(gbuffer.dielectric, colour(glm::vec4(0)))};
    // Reversed depth: background is 0.
    const auto       depth = cleared_attachment(gbuffer.depth_buffer, vk::ClearDepthStencilValue{0.0F, 0});
    const glm::ivec2 size  = gbuffer.view.size_px;
    const vk::Rect2D area{{0, 0}, {static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y)}};
    commands.beginRendering({.renderArea           = area,
                             .layerCount           = 1,
                             .colorAttachmentCount = std::size(colours),
                             .pColorAttachments    = colours,
                             .pDepthAttachment     = &depth});
    commands.setViewport(0, vk::Viewport{0, 0, static_cast<float>(size.x), static_cast<float>(size.y), 0, 1});
    commands.setScissor(0, area);
    draw_scene(commands, *gbuffer.scene, *gbuffer.pipeline, *gbuffer.frame_set.set,
               view_to_clip(gbuffer.view) * gbuffer.view.world_to_view);
    commands.endRendering();
}

/// Which surfaces a G-buffer shows: the nearest, the nearest so far behind another G-buffer, or the next that face the camera.
enum class Shows { first, far_behind, next };

std::shared_ptr<const DrawPipeline> layer_pipeline(Gpu& gpu, GpuScene& scene, const GBuffer& gbuffer, Shows shows)
{
    std::shared_ptr<const DrawPipeline>& pipeline = shows == Shows::first        ? scene.first_layer_pipeline
                                                    : shows == Shows::far_behind ? scene.second_layer_pipeline
                                                                                 : scene.layer_pipeline;
    if (!pipeline) {
        DrawPipelineOptions options{.fragment_shader = "gbuffer/gbuffer.frag",
                                    .colour_formats  = {gbuffer.normal.format, gbuffer.material.format,
                                                        gbuffer.radiance.format, gbuffer.highlight.format,
                                                        gbuffer.object.format, gbuffer.gradient.format,
                                                        gbuffer.dielectric.format}};
        if (shows != Shows::first) options.fragment_defines = {{"PEELED", "1"}};
        if (shows == Shows::next) options.culling = Culling::back_faces;
        pipeline = std::make_shared<const DrawPipeline>(make_draw_pipeline(gpu, scene, options));
    }
    return pipeline;
}

/// Ready to be drawn. before: the G-buffer that lies before this one; null: none.
GBufferPtr make_drawn_gbuffer(Gpu& gpu, const GpuScenePtr& scene, const View& view, Shows shows, const GBuffer* before)
{
    GBufferPtr gbuffer = make_gbuffer(gpu, view, Filled::drawn);
    gbuffer->scene     = scene;
    gbuffer->depth_buffer =
        make_image(gpu, {.format  = vk::Format::eD32Sfloat,
                         .size_px = view.size_px,
                         .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled});
    fill_frame_uniforms(gpu, *gbuffer);
    gbuffer->frame_set =
        make_frame_set(gpu, *scene, gbuffer->frame_uniforms, before == nullptr ? nullptr : &before->depth);
    gbuffer->pipeline      = layer_pipeline(gpu, *scene, *gbuffer, shows);
    gbuffer->sampler       = {gpu.impl->device, vk::SamplerCreateInfo{}};
    gbuffer->view_uniforms = upload_view(gpu, view, Precision::float32);
    Constants constants;
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(view.projection == Projection::orthographic));
    const ShaderSource background{.file    = "gbuffer/background.comp",
                                  .defines = store_defines(gpu, gbuffer->depth.cells)};
    gbuffer->background = make_compute_pass(gpu, compile_shader(gpu, background),
                                            {{"View", gbuffer->view_uniforms},
                                             {"depth_buffer", {gbuffer->depth_buffer, gbuffer->sampler}},
                                             {"environment_map", {scene->environment_map, scene->environment_sampler}},
                                             {"depth_words", {gbuffer->depth.cells, gbuffer->depth.words}},
                                             {"StoredPlanes", gbuffer->depth.cells},
                                             {"gradient_image", gbuffer->gradient},
                                             {"radiance_image", gbuffer->radiance}},
                                            constants, sizeof(glm::mat4));
    gbuffer->timestamps = make_timestamps(gpu, 2);
    return gbuffer;
}

} // namespace

void record_drawing(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer)
{
    barrier(commands);
    record_rasterisation(commands, gbuffer);
    barrier(commands);
    push(commands, gbuffer.background, glm::mat4(glm::inverse(gbuffer.view.world_to_view)));
    dispatch(commands, gbuffer.background, groups_of_8(gbuffer.view.size_px));
    barrier(commands);
    if (!gbuffer.motion_vectors) return;
    record_motion_vectors(commands, *gbuffer.motion_vectors);
    barrier(commands);
}

GBufferPtr render_gbuffer(Gpu& gpu, const GpuScenePtr& scene, const View& view,
                          const std::optional<FrameMotion>& motion)
{
    GBufferPtr gbuffer = make_drawn_gbuffer(gpu, scene, view, Shows::first, nullptr);
    gbuffer->motion    = motion;
    if (motion && (motion->camera_moves || motion->moving_draws > 0))
        gbuffer->motion_vectors = make_motion_vectors(gpu, *gbuffer, *motion);
    rerender_gbuffer(gpu, *gbuffer);
    prepare_solid_backs(gpu, *gbuffer);
    return gbuffer;
}

GBufferPtr make_second_layer(Gpu& gpu, const GBuffer& first)
{
    return make_drawn_gbuffer(gpu, first.scene, first.view, Shows::far_behind, &first);
}

GBufferPtr make_next_layer(Gpu& gpu, const GBuffer& before)
{
    return make_drawn_gbuffer(gpu, before.scene, before.view, Shows::next, &before);
}

void record_second_layer(const vk::raii::CommandBuffer& commands, const GBuffer& second, double separation_m)
{
    const View&  view = second.view;
    const double unit = view.projection == Projection::perspective ? view.near_m : view.far_m - view.near_m;
    barrier(commands);
    commands.updateBuffer<float>(*second.frame_uniforms.buffer, offsetof(FrameBlock, layer_separation),
                                 static_cast<float>(separation_m / unit));
    record_drawing(commands, second);
}

double rerender_gbuffer(Gpu& gpu, GBuffer& gbuffer)
{
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        write_timestamp(commands, gbuffer.timestamps, 0);
        record_drawing(commands, gbuffer);
        write_timestamp(commands, gbuffer.timestamps, 1);
    });
    return read_intervals_ms(gpu, gbuffer.timestamps)[0];
}

std::vector<float> usable_depth(std::span<const float> depth)
{
    std::vector<float> clean(depth.begin(), depth.end());
    for (float& d : clean)
        if (!(d > 0 && d <= 1)) d = static_cast<float>(BACKGROUND_DEPTH);
    return clean;
}

void upload_surfaces(Gpu& gpu, GBuffer& gbuffer, const GBufferImage& image)
{
    const size_t count = image.depth.size();
    if (count != pixel_count(image.view.size_px))
        throw std::logic_error("upload_surfaces: depth does not match the view's size");
    std::vector<glm::vec4> normal(count);
    std::vector<HalfTexel> material(count);
    std::vector<float>     dielectric(count);
    for (size_t i = 0; i < count; ++i) {
        normal[i]     = {image.normal_vs[i], image.roughness[i]};
        material[i]   = to_half({image.base_colour[i], image.metallic[i]});
        dielectric[i] = dielectric_f0_at(image, i);
    }
    GBufferImage planes;
    planes.view      = image.view;
    planes.depth     = image.depth;
    planes.normal_vs = image.normal_vs;
    planes.gradient  = image.gradient;
    complete_gradients(planes);
    const std::vector<float> depth = usable_depth(image.depth);
    // Background is level, as shaders/gbuffer/background.comp draws it: without a plane it would have a slab, which may end nearer than everything.
    std::vector<uint32_t> gradients;
    for (size_t i = 0; i < count; ++i) gradients.push_back(depth[i] > 0 ? pack_gradient(planes.gradient[i]) : 0);
    std::vector<float> solid = image.solid_back;
    solid.resize(count);
    upload(gpu, gbuffer.gradient, gradients.data(), count * sizeof(uint32_t));
    upload(gpu, gbuffer.solid, solid.data(), count * sizeof(float));
    write_depth(gpu, gbuffer.depth, depth, gradients);
    upload(gpu, gbuffer.normal, normal.data(), count * sizeof(glm::vec4));
    upload(gpu, gbuffer.material, material.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer.dielectric, dielectric.data(), count * sizeof(float));
    for (size_t i = 0; i < std::min(gbuffer.layers.size(), image.layers.size()); ++i)
        upload_surfaces(gpu, *gbuffer.layers[i], image.layers[i]);
}

GBufferPtr upload_gbuffer(Gpu& gpu, const GBufferImage& image)
{
    GBufferPtr gbuffer = make_gbuffer(gpu, image.view, Filled::uploaded);
    upload_surfaces(gpu, *gbuffer, image);
    const size_t           count = image.depth.size();
    std::vector<HalfTexel> radiance(count), highlight(count);
    for (size_t i = 0; i < count; ++i) {
        radiance[i]  = to_half({image.radiance[i], 1});
        highlight[i] = to_half({image.highlight[i], 1});
    }
    upload(gpu, gbuffer->radiance, radiance.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer->highlight, highlight.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer->object, image.object_id.data(), count * sizeof(uint32_t));
    for (const GBufferImage& layer : image.layers) gbuffer->layers.push_back(upload_gbuffer(gpu, layer));
    return gbuffer;
}

GBufferImage read_gbuffer(Gpu& gpu, const GBuffer& gbuffer)
{
    GBufferImage image;
    image.view = gbuffer.view;
    for (const float depth : read_depth(gpu, gbuffer.depth)) image.depth.push_back(depth > 0 ? depth : 0.0F);
    for (const glm::vec4& texel : download_as<glm::vec4>(gpu, gbuffer.normal)) {
        image.normal_vs.emplace_back(texel);
        image.roughness.push_back(texel.w);
    }
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.material)) {
        image.base_colour.emplace_back(from_half(texel));
        image.metallic.push_back(from_half(texel).w);
    }
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.radiance))
        image.radiance.emplace_back(from_half(texel));
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.highlight))
        image.highlight.emplace_back(from_half(texel));
    image.object_id = download_as<uint32_t>(gpu, gbuffer.object);
    for (const uint32_t packed : download_as<uint32_t>(gpu, gbuffer.gradient))
        image.gradient.push_back(unpack_gradient(packed));
    image.solid_back    = download_as<float>(gpu, gbuffer.solid);
    image.dielectric_f0 = download_as<float>(gpu, gbuffer.dielectric);
    if (gbuffer.motion_vectors) image.motion_px = download_as<glm::vec2>(gpu, gbuffer.motion_vectors->vectors_px);
    for (const GBufferPtr& layer : gbuffer.layers) image.layers.push_back(read_gbuffer(gpu, *layer));
    return image;
}

} // namespace ssrlab
