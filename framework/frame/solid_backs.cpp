#include "frame/solid_backs.h"

#include "gpu/compute.h"

namespace ssrlab {

void prepare_solid_backs(Gpu& gpu, GBuffer& gbuffer)
{
    if (!gbuffer.scene || static_cast<bool>(*gbuffer.solid_set.set)) return;
    GpuScene& scene = *gbuffer.scene;
    if (!scene.solid_back_pipeline) {
        const DrawPipelineOptions options{.fragment_shader = "gbuffer/solid_back.frag",
                                          .colour_formats  = {gbuffer.solid.format},
                                          .culling         = Culling::nothing};
        scene.solid_back_pipeline = std::make_shared<const DrawPipeline>(make_draw_pipeline(gpu, scene, options));
    }
    gbuffer.solid_depth = make_image(gpu, {.format  = vk::Format::eD32Sfloat,
                                           .size_px = gbuffer.view.size_px,
                                           .usage   = vk::ImageUsageFlagBits::eDepthStencilAttachment});
    gbuffer.solid_set   = make_frame_set(gpu, scene, gbuffer.frame_uniforms, &gbuffer.depth);
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) { record_solid_backs(commands, gbuffer); });
}

void record_solid_backs(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer)
{
    const auto       colour = cleared_attachment(gbuffer.solid, vk::ClearColorValue{std::array<float, 4>{0, 0, 0, 0}});
    const auto       depth  = cleared_attachment(gbuffer.solid_depth, vk::ClearDepthStencilValue{0.0F, 0});
    const glm::ivec2 size   = gbuffer.view.size_px;
    const vk::Rect2D area{{0, 0}, {static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y)}};
    barrier(commands);
    commands.beginRendering({.renderArea           = area,
                             .layerCount           = 1,
                             .colorAttachmentCount = 1,
                             .pColorAttachments    = &colour,
                             .pDepthAttachment     = &depth});
    commands.setViewport(0, vk::Viewport{0, 0, static_cast<float>(size.x), static_cast<float>(size.y), 0, 1});
    commands.setScissor(0, area);
    draw_scene(commands, *gbuffer.scene, *gbuffer.scene->solid_back_pipeline, *gbuffer.solid_set.set,
               view_to_clip(gbuffer.view) * gbuffer.view.world_to_view);
    commands.endRendering();
    barrier(commands);
}

} // namespace ssrlab
