// The line's GPU part: G-buffer -> rays -> inputs -> trace -> effects -> picture, one technique with one set of values.
#pragma once

#include "core/gbuffer_image.h"
#include "core/image.h"
#include "core/trace_result.h"
#include "gpu/gpu.h"
#include "render/effects.h"
#include "render/technique.h"
#include "scene/scene.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace ssrlab {

struct FrameSettings {
    TraceSettings   trace;
    ParameterValues effects = default_effect_values(); // by the names of effect_parameters()

    bool operator==(const FrameSettings&) const = default;
};

enum class Precision { float32, float64 };

/// Milliseconds by GPU timestamps, of the effects that ran, in their order.
struct FrameTimes {
    std::vector<std::pair<std::string, double>> effects_ms;

    double of(const std::string& effect) const; // 0 when it did not run
    double total_ms() const;
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

/// Plans the frame and compiles what it needs; effects that depend on what is hit make it trace once.
/// Throws SpecError with the technique's file and line when its shader does not compile.
PreparedFramePtr prepare_frame(Gpu& gpu, const FrameBuffersPtr& buffers, const Technique& technique,
                               const ParameterValues& values, const FrameSettings& settings);
/// The same frame with its plan off: every effect that is asked for runs, on every surface. What rays hit is not counted again.
PreparedFramePtr prepare_everything(Gpu& gpu, const PreparedFrame& planned);
/// What runs and why. Of a still picture: its statistics are those of the very frame.
const std::vector<PlannedEffect>& plan_of(const PreparedFrame& frame);
/// Seconds of preparing it that went to counting what its rays hit, which the plan depends on.
double counting_s_of(const PreparedFrame& frame);
/// Whether a frame with everything on would do more. Of one that only shades this is not asked: false.
bool plan_leaves_out(const PreparedFrame& frame);
/// What the plan rests on, a line each.
std::vector<std::string> facts_of_plan(const PreparedFrame& frame);

/// Runs what the plan says once and waits. The first call of a frame includes driver compilation: warm up.
FrameTimes run_frame(Gpu& gpu, PreparedFrame& frame);
/// The reflected picture that the last run_frame of this frame left in the shared buffers. Linear RGB.
Image read_shaded(Gpu& gpu, const PreparedFrame& frame);
/// What the last run_frame of this frame found in the second layer: `hit` there, not_traced elsewhere. Empty when the plan
/// has no hidden layer.
std::optional<TraceResult> read_hidden_hits(Gpu& gpu, const PreparedFrame& frame);
/// The second layer itself, of a frame whose plan has one.
GBufferImage read_second_layer(Gpu& gpu, const PreparedFrame& frame);
/// The picture with another reflection in the place of the traced one: colour and weight of each pixel, weight < 0 where nothing reflects.
/// Leaves this reflection in the shared buffers.
Image composite_reflection(Gpu& gpu, const PreparedFrame& frame, std::span<const glm::vec4> reflection);
/// Traces once with the counting pipeline (work counters on; never timed). Precision float64 gives the double twin.
TraceResult count_frame(Gpu& gpu, PreparedFrame& frame, Precision precision = Precision::float32);

} // namespace ssrlab
