// The images of one view, which the lab traces. Folder-internal, and for frame/, which draws them.
#pragma once

#include "gpu/compute.h"
#include "trace/counts.h"
#include "trace/depth_buffer.h"
#include "trace/lab.h"

#include <optional>

namespace ssrlab {

/// The buffers of structures on one depth, or on one list of rays; allocated when a technique first asks for them.
using StructureBuffers = std::map<std::string, Buffer>; // by "structure.buffer"

/// The tiles to trace and the counts of the G-buffer (shaders/rays/classification.comp).
struct TileBuffers {
    Buffer masks, count, tiles, launch, statistics;
};

struct GBuffer {
    View                              view;
    Buffer                            view_uniforms; // in single precision (shaders/api/view.glsl)
    DepthBuffer                       depth;         // background = BACKGROUND_DEPTH
    GpuImage                          normal;        // RGBA32F: view-space normal, roughness
    GpuImage                          material;      // RGBA16F: base colour, metallic
    GpuImage                          dielectric;    // R32F: reflectance at normal incidence of what is not metal
    GpuImage                          radiance;      // RGBA16F: the same from every direction
    GpuImage                          highlight;     // RGBA16F: depends on the view
    GpuImage                          emission;      // RGBA16F: the part of radiance that the surface emits
    GpuImage                          object;        // R32UI
    GpuImage                          gradient;      // R32UI: of depth, core/plane_gradient.h
    GpuImage                          solid;         // R32F: where the solid behind the pixel ends, 0: thin
    std::optional<GpuImage>           motion_px;     // RG32F: GBufferImage::motion_px; empty: not known
    TileBuffers                       tiles;
    std::shared_ptr<StructureBuffers> structures = std::make_shared<StructureBuffers>(); // on this depth
    std::vector<GBufferPtr>           layers; // behind this one, the nearest first
    /// By the rule of what reflects: dielectric_min_f0 and dielectric_max_roughness.
    std::map<std::pair<double, double>, GBufferCounts> counts;
};

/// By triangles, or by what somebody else drew: then the device's limits on what it can draw do not count.
enum class Filled { drawn, uploaded };

/// The images of a view, without content. Throws SpecError for a size over MAX_IMAGE_PX.
GBufferPtr make_gbuffer(Gpu& gpu, const View& view, Filled filled);
/// Depth, normal and material of a picture of the same size.
void upload_surfaces(Gpu& gpu, GBuffer& gbuffer, const GBufferImage& image);
/// Depth as tracers read it: what shaders/gbuffer/background.comp makes of a depth buffer.
std::vector<float> usable_depth(std::span<const float> depth);

/// What a picture shows at each pixel, and each of its layers, by the names that shaders give them.
Bindings surface_bindings(const GBuffer& gbuffer);
/// Layer 1, layer 2 … by the names that shaders give their images.
void add_layers(Bindings& bindings, std::span<const GBufferPtr> layers);

/// The uniform block of shaders/api/view.glsl.
Buffer upload_view(Gpu& gpu, const View& view, Precision precision);
void   write_view(Gpu& gpu, Buffer& target, const View& view, Precision precision);

} // namespace ssrlab
