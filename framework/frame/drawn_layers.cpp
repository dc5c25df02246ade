// What lies behind a drawn G-buffer: its layers, and the backs of its solids.
#include "frame/drawing.h"

namespace ssrlab {

void draw_layers(Gpu& gpu, Drawing& drawing, int layers)
{
    if (drawing.layers.size() != drawing.gbuffer->layers.size())
        throw std::logic_error("draw_layers: a lab was made before the layers were drawn, and left them empty");
    while (static_cast<int>(drawing.layers.size()) + 1 < layers) {
        const Drawing&    before = drawing.layers.empty() ? drawing : *drawing.layers.back();
        const DrawingPtr& layer  = drawing.layers.emplace_back(make_next_layer(gpu, before));
        submit(gpu, [&](const Commands& commands) { record_drawing(commands, *layer); });
        make_solid_backs(gpu, *layer);
        drawing.gbuffer->layers.push_back(layer->gbuffer);
    }
}

void record_layers(const Commands& commands, const Drawing& drawing, int layers)
{
    for (int i = 0; i + 1 < layers; ++i) record_drawing(commands, *drawing.layers[static_cast<size_t>(i)]);
}

void make_solid_backs(Gpu& gpu, Drawing& drawing)
{
    if (static_cast<bool>(*drawing.solid_set.set)) return;
    GpuScene&      scene   = *drawing.scene;
    const GBuffer& gbuffer = *drawing.gbuffer;
    if (!scene.solid_back_pipeline) {
        const DrawPipelineOptions options{.fragment_shader = "gbuffer/solid_back.frag",
                                          .colour_formats  = {gbuffer.solid.format},
                                          .culling         = Culling::nothing,
                                          .depth_alone     = true};
        scene.solid_back_pipeline = std::make_shared<const DrawPipeline>(make_draw_pipeline(gpu, scene, options));
    }
    drawing.solid_depth = make_image(gpu, {.format  = vk::Format::eD32Sfloat,
                                           .size_px = gbuffer.view.size_px,
                                           .usage   = vk::ImageUsageFlagBits::eDepthStencilAttachment});
    drawing.solid_set   = make_frame_set(gpu, scene, drawing.frame_uniforms, &gbuffer.depth);
    submit(gpu, [&](const Commands& commands) { record_solid_backs(commands, drawing); });
}

void record_solid_backs(const Commands& commands, const Drawing& drawing)
{
    const GBuffer& gbuffer = *drawing.gbuffer;
    const auto     colour =
        cleared_attachment(commands, gbuffer.solid, vk::ClearColorValue{std::array<float, 4>{0, 0, 0, 0}});
    const auto       depth = cleared_attachment(commands, drawing.solid_depth, vk::ClearDepthStencilValue{0.0F, 0});
    const glm::ivec2 size  = gbuffer.view.size_px;
    const vk::Rect2D area{{0, 0}, {static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y)}};
    barrier(commands);
    commands.beginRendering({.renderArea           = area,
                             .layerCount           = 1,
                             .colorAttachmentCount = 1,
                             .pColorAttachments    = &colour,
                             .pDepthAttachment     = &depth});
    commands.setViewport(0, vk::Viewport{0, 0, static_cast<float>(size.x), static_cast<float>(size.y), 0, 1});
    commands.setScissor(0, area);
    draw_scene(commands, *drawing.scene, *drawing.scene->solid_back_pipeline, *drawing.solid_set.set,
               view_to_clip(gbuffer.view) * gbuffer.view.world_to_view);
    commands.endRendering();
    barrier(commands);
}

} // namespace ssrlab
