// The inputs and buffers of a frame's passes. Folder-internal.
#pragma once

#include "frame/directional_albedo.h"
#include "frame/drawing.h"
#include "frame/frame.h"
#include "frame/history_images.h"
#include "trace/lab_passes.h"
#include "world/world.h"

namespace ssrlab {

/// Secondary rays, with the index of each parent ray or pixel.
struct DerivedRays {
    RayBuffers rays;
    Buffer     sources;
    Buffer     throughputs; // bounces: weight of a ray's light in the reflection that it belongs to, RGB
};

/// The images that cones read (shaders/passes/cone_pyramid.comp).
struct ConePyramid {
    GpuImage cells;  // RGBA16F: colour, visibility
    GpuImage ranges; // RG32F: nearest and farthest distance in metres
};

/// Light and end of each ray of rough pixels; one image per ray, stacked vertically (shaders/passes/ray_reuse.comp).
/// The last two are one image high and hold shaders/passes/reused_pixel.glsl.
struct LobeRayImages {
    GpuImage light;            // RGBA16F: colour, weight; unused with one ray per pixel: `reflection` has it
    GpuImage end;              // RGBA32F: the point in view space, and the density of the ray's direction
    GpuImage gathered, reused; // RGBA32UI
};

struct FrameBuffers {
    GBufferPtr gbuffer;
    WorldPtr   world;   // null until a frame asks for it, and where the G-buffer was made elsewhere
    DrawingPtr drawing; // null: the G-buffer was made elsewhere
    std::map<std::tuple<size_t, int, bool>, std::shared_ptr<RayBuffers>> rays;   // by capacity and content; float
    DrawingPtr                                                     second_layer; // empty until a frame asks for it
    std::shared_ptr<ConePyramid>                                   cone;         // empty until a frame asks for it
    std::map<std::pair<size_t, int>, std::shared_ptr<DerivedRays>> derived_rays; // by capacity and number, 0 or 1
    std::map<int, std::shared_ptr<LobeRayImages>>                  lobe_rays;    // by rays per pixel
    GpuImage     reflection;   // RGBA16F: colour, weight; weight < 0 if no ray started
    GpuImage     filtered;     // RGBA16F: the target of a filter, or an earlier reflection
    GpuImage     small_colour; // RGBA16F, half size or less: lit colour for rays at a lower resolution
    GpuImage     block_pixel;  // R32UI, half size or less: the pixel of a block that has rays, or NO_PIXEL
    GpuImage     shaded;       // RGBA16F
    SampledTable dfg_table;    // dfg_table()
    Buffer       ambient;      // vec3: the scene's ambient radiance, or 0
};

/// Everything that determines the passes of one frame.
struct FrameInputs {
    LabPtr                      lab;
    FrameBuffersPtr             buffers;
    FramePlan                   plan;
    FrameHistoryPtr             history; // of the frame before, or null
    MotionBuffers               motion;  // since that frame; empty without a history to use
    std::shared_ptr<RayBuffers> rays;
    TracePasses                 trace;                 // of these rays
    Buffer                      answers;               // a RayLight per ray; empty if the frame answers them all
    bool                        answers_given = false; // Answers::given
};

struct ReadyFrame {
    FrameInputs                 inputs;
    std::vector<RecordFunction> record_functions; // of the passes that run; they refer to `inputs`
    Timestamps                  timestamps;
};

/// Runs the passes from `first` to before `last`, in one submit, `frames` times, and returns the times of the last.
/// `timestamps`: one more than passes.
FrameTimes run_passes(Gpu& gpu, const ReadyFrame& frame, const Timestamps& timestamps, size_t first, size_t last,
                      int frames = 1);

/// Return the choice of rays that a plan's values describe, and buffers with room for them.
RayChoice                   rays_of(const ParameterValues& passes);
std::shared_ptr<RayBuffers> ray_buffers(Gpu& gpu, FrameBuffers& buffers, const GBufferCounts& counts,
                                        const ParameterValues& passes);
/// Returns room for a RayLight per ray.
Buffer make_answers(Gpu& gpu, const RayBuffers& rays);
/// Returns the plan of a frame whose pixels and hits are already counted.
FramePlan plan_with(const Catalogue& catalogue, const Lab& lab, const FrameBuffers& buffers,
                    const FrameSettings& settings, const FrameHistory* history, const GBufferCounts& counts,
                    const TraceCounts& hits);

/// Returns the scene that the G-buffer shows; null if it was made elsewhere.
GpuScene* scene_of(const FrameBuffers& buffers);

} // namespace ssrlab
