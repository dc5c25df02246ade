#include "frame/both_sides.h"

#include "core/error.h"
#include "shared.h"
#include "trace/lab_passes.h"

namespace ssrlab {
namespace {

/// shaders/gbuffer/gbuffer.frag, uniform Frame, scalar layout.
struct FrameBlock {
    glm::mat4  world_to_view;
    glm::vec3  eye_ws;
    int32_t    orthographic;
    glm::vec3  view_axis_ws;
    glm::vec3  ambient;
    float      layer_separation = 0;
    glm::ivec2 size_px{0, 0};
};

void fill_frame_uniforms(Gpu& gpu, Drawing& drawing)
{
    const glm::dmat4 view_to_world = glm::inverse(drawing.gbuffer->view.world_to_view);
    const FrameBlock block{glm::mat4(drawing.gbuffer->view.world_to_view),
                           glm::vec3(view_to_world[3]),
                           drawing.gbuffer->view.projection == Projection::orthographic,
                           glm::vec3(-view_to_world[2]),
                           drawing.scene->ambient,
                           0,
                           drawing.gbuffer->view.size_px};
    drawing.frame_uniforms = make_buffer(gpu, sizeof(block));
    upload(gpu, drawing.frame_uniforms, &block, sizeof(block));
}

} // namespace

vk::RenderingAttachmentInfo cleared_attachment(const Commands& commands, const GpuImage& image, vk::ClearValue clear)
{
    note(commands, {.uses = {{storage_of(image), false, true}}});
    return {.imageView   = *image.view,
            .imageLayout = vk::ImageLayout::eGeneral,
            .loadOp      = vk::AttachmentLoadOp::eClear,
            .storeOp     = vk::AttachmentStoreOp::eStore,
            .clearValue  = clear};
}

namespace {

vk::ClearValue colour(glm::vec4 c) { return vk::ClearColorValue{std::array<float, 4>{c.x, c.y, c.z, c.w}}; }

void record_rasterisation(const Commands& commands, const Drawing& drawing)
{
    const GBuffer&                    gbuffer   = *drawing.gbuffer;
    const vk::RenderingAttachmentInfo colours[] = {
        cleared_attachment(commands, gbuffer.normal, colour(glm::vec4(0))),
        cleared_attachment(commands, gbuffer.material, colour(glm::vec4(0))),
        cleared_attachment(commands, gbuffer.radiance, colour(glm::vec4(0))),
        cleared_attachment(commands, gbuffer.highlight, colour(glm::vec4(0))),
        cleared_attachment(commands, gbuffer.object, vk::ClearColorValue{std::array<uint32_t, 4>{0, 0, 0, 0}}),
        cleared_attachment(commands, gbuffer.gradient, vk::ClearColorValue{std::array<uint32_t, 4>{0, 0, 0, 0}}),
        cleared_attachment(commands, gbuffer.dielectric, colour(glm::vec4(0))),
        cleared_attachment(commands, gbuffer.emission, colour(glm::vec4(0)))};
    // Reversed depth: background is 0.
    const auto       depth = cleared_attachment(commands, drawing.depth_buffer, vk::ClearDepthStencilValue{0.0F, 0});
    const glm::ivec2 size  = gbuffer.view.size_px;
    const vk::Rect2D area{{0, 0}, {static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y)}};
    commands.beginRendering({.renderArea           = area,
                             .layerCount           = 1,
                             .colorAttachmentCount = std::size(colours),
                             .pColorAttachments    = colours,
                             .pDepthAttachment     = &depth});
    commands.setViewport(0, vk::Viewport{0, 0, static_cast<float>(size.x), static_cast<float>(size.y), 0, 1});
    commands.setScissor(0, area);
    draw_scene(commands, *drawing.scene, *drawing.pipeline, *drawing.frame_set.set,
               view_to_clip(gbuffer.view) * gbuffer.view.world_to_view);
    commands.endRendering();
}

/// Which surfaces a G-buffer shows: the nearest, the nearest so far behind another G-buffer, the next that face the
/// camera, or the next of either side.
enum class Shows { first, far_behind, next, next_side };

/// before: as make_drawing() has it.
std::shared_ptr<const DrawPipeline> layer_pipeline(Gpu& gpu, GpuScene& scene, const GBuffer& gbuffer, Shows shows,
                                                   const Drawing* before)
{
    // Layers of both sides share the pipeline of the first of them.
    std::shared_ptr<const DrawPipeline> of_sides;
    if (shows == Shows::next_side && before->pipeline && before->pipeline->culling == Culling::nothing)
        of_sides = before->pipeline;
    std::shared_ptr<const DrawPipeline>& pipeline = shows == Shows::next_side    ? of_sides
                                                    : shows == Shows::first      ? scene.first_layer_pipeline
                                                    : shows == Shows::far_behind ? scene.second_layer_pipeline
                                                                                 : scene.layer_pipeline;
    if (!pipeline) {
        DrawPipelineOptions options{.fragment_shader = "gbuffer/gbuffer.frag",
                                    .colour_formats  = {gbuffer.normal.format, gbuffer.material.format,
                                                        gbuffer.radiance.format, gbuffer.highlight.format,
                                                        gbuffer.object.format, gbuffer.gradient.format,
                                                        gbuffer.dielectric.format, gbuffer.emission.format}};
        if (shows != Shows::first) options.fragment_defines = {{"PEELED", "1"}};
        if (shows == Shows::next) options.culling = Culling::back_faces;
        if (shows == Shows::next_side) options.culling = Culling::nothing;
        pipeline = std::make_shared<const DrawPipeline>(make_draw_pipeline(gpu, scene, options));
    }
    return pipeline;
}

/// Ready to be drawn. before: what lies before this one; null: nothing.
DrawingPtr make_drawing(Gpu& gpu, const GpuScenePtr& scene, const View& view, Shows shows, const Drawing* before)
{
    auto drawing     = std::make_shared<Drawing>();
    drawing->gbuffer = make_gbuffer(gpu, view, Filled::drawn);
    drawing->scene   = scene;
    drawing->depth_buffer =
        make_image(gpu, {.format  = vk::Format::eD32Sfloat,
                         .size_px = view.size_px,
                         .usage = vk::ImageUsageFlagBits::eDepthStencilAttachment | vk::ImageUsageFlagBits::eSampled});
    fill_frame_uniforms(gpu, *drawing);
    const GBuffer& gbuffer = *drawing->gbuffer;
    drawing->frame_set =
        make_frame_set(gpu, *scene, drawing->frame_uniforms, before == nullptr ? nullptr : &before->gbuffer->depth);
    drawing->pipeline = layer_pipeline(gpu, *scene, gbuffer, shows, before);
    drawing->sampler  = {gpu.impl->device, vk::SamplerCreateInfo{}};
    Constants constants;
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(view.projection == Projection::orthographic));
    const ShaderSource background{.file    = "gbuffer/background.comp",
                                  .defines = store_defines(gpu, gbuffer.depth.cells)};
    drawing->background = make_compute_pass(gpu, compile_shader(gpu, background),
                                            {{"View", gbuffer.view_uniforms},
                                             {"depth_buffer", {drawing->depth_buffer, drawing->sampler}},
                                             {"environment_map", scene->environment_map},
                                             {"depth_words", depth_bindings(gbuffer.depth).at("depth_words")},
                                             {"StoredPlanes", gbuffer.depth.cells},
                                             {"gradient_image", gbuffer.gradient},
                                             {"radiance_image", gbuffer.radiance}},
                                            constants, sizeof(glm::mat4));
    drawing->timestamps = make_timestamps(gpu, 2);
    return drawing;
}

} // namespace

void record_drawing(const Commands& commands, const Drawing& drawing)
{
    const View& view = drawing.gbuffer->view;
    barrier(commands);
    record_rasterisation(commands, drawing);
    barrier(commands);
    push(commands, drawing.background, glm::mat4(glm::inverse(view.world_to_view)));
    dispatch(commands, drawing.background, groups_of_8(view.size_px));
    barrier(commands);
    if (!drawing.motion_vectors) return;
    record_motion_vectors(commands, *drawing.motion_vectors, *drawing.gbuffer);
    barrier(commands);
}

DrawingPtr draw_gbuffer(Gpu& gpu, const GpuScenePtr& scene, const View& view, const std::optional<FrameMotion>& motion)
{
    DrawingPtr drawing = make_drawing(gpu, scene, view, Shows::first, nullptr);
    drawing->motion    = motion;
    if (motion && (motion->camera_moves || motion->moving_draws > 0))
        drawing->motion_vectors = make_motion_vectors(gpu, *drawing->gbuffer, *motion);
    redraw_gbuffer(gpu, *drawing);
    make_solid_backs(gpu, *drawing);
    return drawing;
}

const GBufferPtr& gbuffer_of(const Drawing& drawing) { return drawing.gbuffer; }

DrawingPtr make_second_layer(Gpu& gpu, const Drawing& first)
{
    return make_drawing(gpu, first.scene, first.gbuffer->view, Shows::far_behind, &first);
}

DrawingPtr make_next_layer(Gpu& gpu, const Drawing& before)
{
    return make_drawing(gpu, before.scene, before.gbuffer->view, Shows::next, &before);
}

DrawingPtr make_next_side(Gpu& gpu, const Drawing& before)
{
    return make_drawing(gpu, before.scene, before.gbuffer->view, Shows::next_side, &before);
}

DrawnSides draw_sides_behind(Gpu& gpu, const GpuScenePtr& scene, const View& view, std::span<const float> depth,
                             std::shared_ptr<const DrawPipeline>& pipeline)
{
    Drawing before;
    before.gbuffer           = upload_depth(gpu, view, depth);
    before.pipeline          = pipeline;
    const DrawingPtr drawing = make_drawing(gpu, scene, view, Shows::next_side, &before);
    pipeline                 = drawing->pipeline;
    redraw_gbuffer(gpu, *drawing); // a driver may compile a pipeline when it first draws
    return {drawing->gbuffer, redraw_gbuffer(gpu, *drawing)};
}

void record_second_layer(const Commands& commands, const Drawing& second, double separation_m)
{
    const View&  view = second.gbuffer->view;
    const double unit = view.projection == Projection::perspective ? view.near_m : view.far_m - view.near_m;
    barrier(commands);
    commands.updateBuffer<float>(*second.frame_uniforms.buffer, offsetof(FrameBlock, layer_separation),
                                 static_cast<float>(separation_m / unit));
    record_drawing(commands, second);
}

double redraw_gbuffer(Gpu& gpu, Drawing& drawing)
{
    submit(gpu, [&](const Commands& commands) {
        write_timestamp(commands, drawing.timestamps, 0);
        record_drawing(commands, drawing);
        write_timestamp(commands, drawing.timestamps, 1);
    });
    return read_intervals_ms(gpu, drawing.timestamps)[0];
}

} // namespace ssrlab
