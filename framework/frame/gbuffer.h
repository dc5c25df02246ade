// The images of one view, and what renders them.
#pragma once

#include "frame/gpu_scene.h"
#include "frame/motion_vectors.h"
#include "trace/depth_buffer.h"
#include "trace/structure_passes.h"

namespace ssrlab {

struct GBuffer {
    View        view;
    GpuScenePtr scene;        // empty when the G-buffer was made elsewhere
    GpuImage    depth_buffer; // D32, what the rasteriser wrote
    DepthBuffer depth;        // what tracers read: background = BACKGROUND_DEPTH
    GpuImage    normal;       // RGBA32F: view-space normal, roughness
    GpuImage    material;     // RGBA16F: base colour, metallic
    GpuImage    dielectric;   // R32F: reflectance at normal incidence of what is not metal
    GpuImage    radiance;     // RGBA16F: the same from every direction
    GpuImage    highlight;    // RGBA16F: depends on the view
    GpuImage    object;       // R32UI
    GpuImage    gradient;     // R32UI: of depth, core/plane_gradient.h
    GpuImage    solid;        // R32F: where the solid behind the pixel ends, 0: thin; solid_backs.h draws it
    GpuImage    solid_depth;  // D32, of that pass
    FrameSet    solid_set;
    Buffer      frame_uniforms;
    FrameSet    frame_set;
    std::shared_ptr<const DrawPipeline> pipeline;
    vk::raii::Sampler                   sampler = nullptr;
    Buffer                              view_uniforms;
    ComputePass                         background;
    std::optional<FrameMotion>          motion;         // since the frame before, if there was one
    std::optional<MotionVectors>        motion_vectors; // if anything moved
    Timestamps                          timestamps;
    std::shared_ptr<StructureBuffers>   structures = std::make_shared<StructureBuffers>(); // on this depth
    std::vector<GBufferPtr>             layers; // behind this one, the nearest first; layers.h makes and draws them
};

/// An image to draw into, cleared first.
vk::RenderingAttachmentInfo cleared_attachment(const GpuImage& image, vk::ClearValue clear);

/// Depth as tracers read it: what shaders/gbuffer/background.comp makes of a depth buffer.
std::vector<float> usable_depth(std::span<const float> depth);
/// Depth, normal and material of a picture of the same size.
void upload_surfaces(Gpu& gpu, GBuffer& gbuffer, const GBufferImage& image);

/// What a scene's G-buffer hides: the same images again, of the nearest surfaces that lie more than the separation behind it.
/// `first` must outlive it.
GBufferPtr make_second_layer(Gpu& gpu, const GBuffer& first);
void       record_second_layer(const vk::raii::CommandBuffer& commands, const GBuffer& second, double separation_m);

/// By triangles, or by what somebody else drew: then the device's limits on what it can draw do not count.
enum class Filled { drawn, uploaded };

/// The images of a view, without content.
GBufferPtr make_gbuffer(Gpu& gpu, const View& view, Filled filled);
/// The next layer behind one that was drawn from a scene: the same images, of the nearest surfaces behind it that face the camera.
/// `before` must outlive it.
GBufferPtr make_next_layer(Gpu& gpu, const GBuffer& before);
void       record_drawing(const vk::raii::CommandBuffer& commands, const GBuffer& gbuffer);

} // namespace ssrlab
