// Drawing the triangles of a scene into a G-buffer and the layers behind it. Folder-internal.
#pragma once

#include "frame/gpu_scene.h"
#include "frame/motion_vectors.h"
#include "trace/gbuffer.h"

namespace ssrlab {

struct Drawing {
    GBufferPtr                          gbuffer;
    GpuScenePtr                         scene;
    GpuImage                            depth_buffer; // D32, written by the rasteriser
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

/// Returns the second layer of a G-buffer: the nearest surfaces that lie more than the separation behind it. `first`
/// must outlive it.
DrawingPtr make_second_layer(Gpu& gpu, const Drawing& first);
void       record_second_layer(const Commands& commands, const Drawing& second, double separation_m);

/// Returns the next layer: the nearest surfaces behind `before` that face the camera. `before` must
/// outlive it.
DrawingPtr make_next_layer(Gpu& gpu, const Drawing& before);
void       record_drawing(const Commands& commands, const Drawing& drawing);

/// Records drawing the first `layers` - 1 layers behind the G-buffer again.
void record_layers(const Commands& commands, const Drawing& drawing, int layers);

/// Prepares record_solid_backs() and draws once; a second call does nothing.
void make_solid_backs(Gpu& gpu, Drawing& drawing);
/// Records drawing GBuffer::solid, where the solids end whose fronts the G-buffer shows: the scene once more, with back
/// faces, behind the G-buffer (docs/reference/hit_contract.md, plane_solid).
void record_solid_backs(const Commands& commands, const Drawing& drawing);

/// Returns an attachment for drawing into an image that is cleared first.
vk::RenderingAttachmentInfo cleared_attachment(const Commands& commands, const GpuImage& image, vk::ClearValue clear);

} // namespace ssrlab
