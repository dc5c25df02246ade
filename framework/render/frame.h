// The line's GPU part: G-buffer -> rays -> inputs -> trace -> shade, one technique with one set of values.
#pragma once

#include "core/gbuffer_image.h"
#include "core/image.h"
#include "core/trace_result.h"
#include "gpu/gpu.h"
#include "render/technique.h"
#include "scene/scene.h"

#include <memory>

namespace ssrlab {

/// How a hit becomes colour: C = C_frag + (C_reflect - C_frag) * beta (the OpenGL report of J. Somerville Roberts).
struct ShadeSettings {
    double metallic_exponent = 3;    // beta = metallic ^ exponent; 0 switches the factor off
    bool   fade_to_viewer    = true; // beta *= max(0, -R.z): reflections toward the viewer show the wrong side
    bool   fade_at_edges     = true; // beta *= clamp(1 - |u - 0.5| - |v - 0.5|, 0, 1)
};

struct FrameSettings {
    TraceSettings trace;
    ShadeSettings shade;
};

enum class Precision { float32, float64 };

/// Milliseconds by GPU timestamps; frame is the sum of the passes with the G-buffer's median.
struct PassTimes {
    double rays_ms = 0, inputs_ms = 0, trace_ms = 0, shade_ms = 0;
};

struct GpuScene;      // a scene's buffers, textures and shadow maps
struct GBuffer;       // images of one view
struct FrameBuffers;  // rays, derived inputs and results: allocated once per image size, shared by all runs on it
struct PreparedFrame; // the pipelines of one run

using GpuScenePtr      = std::shared_ptr<GpuScene>;
using GBufferPtr       = std::shared_ptr<GBuffer>;
using FrameBuffersPtr  = std::shared_ptr<FrameBuffers>;
using PreparedFramePtr = std::shared_ptr<PreparedFrame>;

/// Uploads the scene and renders its shadow maps.
GpuScenePtr upload_scene(Gpu& gpu, const Scene& scene);

/// Renders the G-buffer; call again for another timing. Throws SpecError when the size exceeds the device's limit.
GBufferPtr render_gbuffer(Gpu& gpu, const GpuScenePtr& scene, const View& view);
/// Renders into the same images again; returns milliseconds.
double rerender_gbuffer(Gpu& gpu, GBuffer& gbuffer);
/// A G-buffer made elsewhere (another renderer, a test).
GBufferPtr   upload_gbuffer(Gpu& gpu, const GBufferImage& image);
GBufferImage read_gbuffer(Gpu& gpu, const GBuffer& gbuffer);

FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer);

/// Compiles what the run needs. Throws SpecError with the technique's file and line when its shader does not compile.
PreparedFramePtr prepare_frame(Gpu& gpu, const FrameBuffersPtr& buffers, const Technique& technique,
                               const ParameterValues& values, const FrameSettings& settings);

/// Runs all passes once and waits. The first call of a frame includes driver compilation: warm up.
PassTimes run_frame(Gpu& gpu, PreparedFrame& frame);
/// The reflected picture that the last run_frame of this frame left in the shared buffers. Linear RGB.
Image read_shaded(Gpu& gpu, PreparedFrame& frame);
/// Traces once with the counting pipeline (work counters on; never timed). Precision float64 gives the double twin.
TraceResult count_frame(Gpu& gpu, PreparedFrame& frame, Precision precision = Precision::float32);

} // namespace ssrlab
