// How the triangles of a scene become a G-buffer and the layers behind it. Folder-internal.
#pragma once

#include "frame/gpu_scene.h"
#include "frame/motion_vectors.h"
#include "trace/gbuffer.h"

namespace ssrlab {

struct Drawing {
    GBufferPtr                          gbuffer;
    GpuScenePtr                         scene;
    GpuImage                            depth_buffer; // D32, what the rasteriser writes
    GpuImage                            solid_depth;  // D32, of the pass that draws GBuffer::solid
    FrameSet                            solid_set;
    Buffer                              frame_uniforms;
    FrameSet                            frame_set;
    std::shared_ptr<const DrawPipeline> pipeline;
    vk::raii::Sampler                   sampler = nullptr;
    ComputePass                         background;
    std::optional<FrameMotion>          motion;         // since the frame before, if there was one
    std::optional<MotionVectors>        motion_vectors; // if anything moved
    Timestamps                          timestamps;
    std::vector<DrawingPtr>             layers; // of gbuffer->layers
};

/// What a scene's G-buffer hides: the same images again, of the nearest surfaces that lie more than the separation
/// behind it. `first` must outlive it.
DrawingPtr make_second_layer(Gpu& gpu, const Drawing& first);
void       record_second_layer(const vk::raii::CommandBuffer& commands, const Drawing& second, double separation_m);

/// The next layer behind one: the same images, of the nearest surfaces behind it that face the camera. `before` must
/// outlive it.
DrawingPtr make_next_layer(Gpu& gpu, const Drawing& before);
void       record_drawing(const vk::raii::CommandBuffer& commands, const Drawing& drawing);

/// Draws the first `layers` - 1 layers behind the G-buffer once more.
void record_layers(const vk::raii::CommandBuffer& commands, const Drawing& drawing, int layers);

/// Makes ready what record_solid_backs() needs and draws once; a second call does nothing.
void make_solid_backs(Gpu& gpu, Drawing& drawing);
/// Where the solids end whose fronts the G-buffer shows (docs/reference/hit_contract.md, plane_solid): draws the scene once more,
/// back faces included, behind what the G-buffer shows.
void record_solid_backs(const vk::raii::CommandBuffer& commands, const Drawing& drawing);

/// An image to draw into, cleared first.
vk::RenderingAttachmentInfo cleared_attachment(const GpuImage& image, vk::ClearValue clear);

} // namespace ssrlab
