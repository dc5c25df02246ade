// The images of one view. For the folders trace/, which traces them, and frame/, which draws them.
#pragma once

#include "gpu/compute.h"
#include "trace/counts.h"
#include "trace/depth_buffer.h"
#include "trace/lab.h"

#include <optional>

namespace ssrlab {

/// Buffers of structures, for one depth buffer or one list of rays; allocated when a technique first needs them.
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
    GpuImage                          radiance;      // RGBA16F: the part that is the same from every direction
    GpuImage                          highlight;     // RGBA16F: the part that depends on the view
    GpuImage                          emission;      // RGBA16F: emitted part of radiance, diffuse_share
    GpuImage                          object;        // R32UI
    GpuImage                          gradient;      // R32UI: of depth, core/plane_gradient.h
    GpuImage                          solid;         // R32F: where the solid behind the pixel ends, 0: thin
    std::optional<GpuImage>           motion_px;     // RG32F: GBufferImage::motion_px; empty: not known
    TileBuffers                       tiles;
    std::shared_ptr<StructureBuffers> structures = std::make_shared<StructureBuffers>(); // on this depth
    std::vector<GBufferPtr>           layers; // behind this one, the nearest first
    /// Counts by dielectric_min_f0 and dielectric_max_roughness, which decide what reflects.
    std::map<std::pair<double, double>, GBufferCounts> counts;
};

/// How a G-buffer gets its content. The device's limits on drawing apply to `drawn` only.
enum class Filled { drawn, uploaded };

/// Returns the images of a view, with undefined content. Throws SpecError for a size over MAX_IMAGE_PX.
GBufferPtr make_gbuffer(Gpu& gpu, const View& view, Filled filled);
/// Uploads depth, normal and material of an image of the same size.
void upload_surfaces(Gpu& gpu, GBuffer& gbuffer, const GBufferImage& image);
/// Returns depth with background as tracers expect it, as shaders/gbuffer/background.comp does.
std::vector<float> usable_depth(std::span<const float> depth);

/// Returns the images of a G-buffer and of its layers, by their names in shaders.
Bindings surface_bindings(const GBuffer& gbuffer);
/// Adds the images of layers 1, 2 …, by their names in shaders.
void add_layers(Bindings& bindings, std::span<const GBufferPtr> layers);

/// Returns the uniform block of shaders/api/view.glsl.
Buffer upload_view(Gpu& gpu, const View& view, NumberFormat number_format);
void   write_view(Gpu& gpu, Buffer& target, const View& view, NumberFormat number_format);

} // namespace ssrlab
