// What the passes of a frame work on. Folder-internal.
#pragma once

#include "frame/drawing.h"
#include "frame/frame.h"
#include "frame/history_images.h"
#include "trace/lab_passes.h"

namespace ssrlab {

/// Rays that come from other rays: a list of their own, and of each the ray or pixel that it belongs to.
struct DerivedRays {
    RayBuffers rays;
    Buffer     sources;
    Buffer     throughputs; // bounces: what a ray's light still weighs in the reflection it belongs to, RGB
};

/// What cones look up (shaders/passes/cone_pyramid.comp).
struct ConePyramid {
    GpuImage cells;  // RGBA16F: colour, visibility
    GpuImage ranges; // RG32F: nearest and farthest distance in metres
};

/// What each ray of a rough pixel brought back, ray after ray, each an image high (shaders/passes/ray_reuse.comp).
struct LobeRayImages {
    GpuImage light; // RGBA16F: colour, weight; with one ray per pixel the reflection takes its place
    GpuImage end;   // RGBA32F: the point in view space, and the density of the ray's direction
};

struct FrameBuffers {
    GBufferPtr gbuffer;
    DrawingPtr drawing;                                                        // null: the G-buffer was made elsewhere
    std::map<std::tuple<size_t, int, bool>, std::shared_ptr<RayBuffers>> rays; // by capacity and what they hold; float
    DrawingPtr                                                     second_layer; // empty until a frame asks for it
    std::shared_ptr<ConePyramid>                                   cone;         // empty until a frame asks for it
    std::map<std::pair<size_t, int>, std::shared_ptr<DerivedRays>> derived_rays; // by capacity, and which of two
    std::map<int, std::shared_ptr<LobeRayImages>>                  lobe_rays;    // by rays per pixel
    GpuImage          reflection;   // RGBA16F: colour, weight; weight < 0 where no ray started
    GpuImage          filtered;     // RGBA16F: a reflection that a filter is writing, or an earlier one
    GpuImage          small_colour; // RGBA16F, half size or less: lit colour as rays at a lower resolution find it
    GpuImage          block_pixel;  // R32UI, half size or less: which pixel of a block has rays, or NO_PIXEL
    GpuImage          shaded;       // RGBA16F
    GpuImage          dfg_table;    // RG16F: dfg_table()
    Buffer            ambient;      // vec3: the scene's ambient radiance, or 0
    vk::raii::Sampler dfg_sampler = nullptr;
};

/// All that decides what the passes of one frame do.
struct FrameInputs {
    LabPtr                      lab;
    FrameBuffersPtr             buffers;
    FramePlan                   plan;
    FrameHistoryPtr             history; // of the frame before, or null
    MotionBuffers               motion;  // since that frame; empty without a history to use
    std::shared_ptr<RayBuffers> rays;
    TracePasses                 trace; // of these rays
};

struct ReadyFrame {
    FrameInputs                 inputs;
    std::vector<RecordFunction> record_functions; // of the passes that run; they refer to `inputs`
    Timestamps                  timestamps;
};

/// The rays of a plan's values, and room for them.
RayChoice                   rays_of(const ParameterValues& passes);
std::shared_ptr<RayBuffers> ray_buffers(Gpu& gpu, FrameBuffers& buffers, const GBufferCounts& counts,
                                        const ParameterValues& passes);
/// The plan of a frame whose pixels and hits are already counted.
FramePlan plan_with(const Catalogue& catalogue, const Lab& lab, const FrameBuffers& buffers,
                    const FrameSettings& settings, const FrameHistory* history, const GBufferCounts& counts,
                    const TraceCounts& hits);

/// The scene that the G-buffer shows; null: it was made elsewhere.
GpuScene* scene_of(const FrameBuffers& buffers);

} // namespace ssrlab
