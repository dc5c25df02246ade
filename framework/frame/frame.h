// The line's GPU part: G-buffer -> rays -> structures -> trace -> shade -> image, one technique with one set of values.
#pragma once

#include "core/gbuffer_image.h"
#include "core/image.h"
#include "core/trace_result.h"
#include "frame/frame_plan.h"
#include "frame/history.h"
#include "gpu/compiled.h"
#include "scene/sequence.h"
#include "trace/technique.h"

#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace ssrlab {

/// A frame's defaults are what measures best (docs/explanation/surfaces.md); TraceSettings alone are the simplest contract.
struct FrameSettings {
    TraceSettings   trace  = {.behind = Behind::stop, .surface = "plane_solid"};
    ParameterValues passes = default_pass_values(); // by the names of pass_parameters()

    bool operator==(const FrameSettings&) const = default;
};

enum class Precision { float32, float64 };

/// Milliseconds by GPU timestamps, of the passes that ran, in their order.
struct FrameTimes {
    std::vector<std::pair<std::string, double>> passes_ms;

    double of(const std::string& pass) const; // 0 when it did not run
    double total_ms() const;
};

struct GpuScene;      // a scene's buffers, textures and shadow maps
struct GBuffer;       // images of one view
struct FrameBuffers;  // rays and results: allocated once per image size, shared by all runs on it
struct PreparedFrame; // the pipelines of one run

using GpuScenePtr      = std::shared_ptr<GpuScene>;
using GBufferPtr       = std::shared_ptr<GBuffer>;
using FrameBuffersPtr  = std::shared_ptr<FrameBuffers>;
using PreparedFramePtr = std::shared_ptr<PreparedFrame>;

/// Uploads the scene and renders its shadow maps.
GpuScenePtr upload_scene(Gpu& gpu, const Scene& scene);

/// The same scene with its draws elsewhere: vertices and shadow maps anew, in the buffers that are there.
void move_scene(Gpu& gpu, GpuScene& uploaded, const Scene& moved);

/// What these values need and the device lacks, in words; empty: nothing.
std::string missing_feature(const Gpu& gpu, const Technique& technique, const ParameterValues& values);

/// Renders the G-buffer; call again for another timing. Throws SpecError when the size exceeds the device's limit.
/// motion: since the frame before; where anything moved, the G-buffer has motion vectors.
GBufferPtr render_gbuffer(Gpu& gpu, const GpuScenePtr& scene, const View& view,
                          const std::optional<FrameMotion>& motion = {});
/// Renders into the same images again; returns milliseconds.
double rerender_gbuffer(Gpu& gpu, GBuffer& gbuffer);
/// A G-buffer made elsewhere (another renderer, a test).
GBufferPtr   upload_gbuffer(Gpu& gpu, const GBufferImage& image);
GBufferImage read_gbuffer(Gpu& gpu, const GBuffer& gbuffer);

FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer);

/// Plans the frame and compiles what it needs; if passes depend on hits, it traces once.
/// history: what the frame before left, or null for a single frame.
/// Throws SpecError with the technique's file and line when its shader does not compile.
PreparedFramePtr prepare_frame(Gpu& gpu, const FrameBuffersPtr& buffers, const Technique& technique,
                               const ParameterValues& values, const FrameSettings& settings,
                               const FrameHistoryPtr& history = nullptr);
/// The same frame, unculled: every pass that is not off runs, on every surface. Hits are not counted again.
PreparedFramePtr prepare_unculled(Gpu& gpu, const PreparedFrame& planned);
/// What runs and why. The frame is still, so the plan's statistics are its own.
const std::vector<PlannedPass>& plan_of(const PreparedFrame& frame);
/// Pixels that reflect.
size_t reflecting_pixels_of(const PreparedFrame& frame);
/// Seconds of prepare_frame() spent counting hits for the plan.
double counting_s_of(const PreparedFrame& frame);
/// On a device that only compiles (gpu/compiled.h): every pipeline of a frame at 1080p, as if every pixel reflected, one half of them
/// as mirrors and one half with a roughness of a quarter, and every ray hit. There is no scene: what draws it is left out.
std::vector<CompiledPtr> compile_frame(Gpu& gpu, const Technique& technique, const ParameterValues& values,
                                       const FrameSettings& settings);
/// Whether the unculled frame would do more. False with pass_set = shading.
bool plan_skips_work(const PreparedFrame& frame);
/// What the plan rests on, a line each.
std::vector<std::string> facts_of_plan(const PreparedFrame& frame);

/// Runs the planned passes and waits. The first call of a frame includes driver compilation: warm up.
/// frames: so many times, one after another, in one submit. The times are those of the last.
FrameTimes run_frame(Gpu& gpu, PreparedFrame& frame, int frames = 1);
/// The image that the last run_frame of this frame left in the shared buffers. Linear RGB.
Image read_shaded(Gpu& gpu, const PreparedFrame& frame);
/// What the last run_frame of this frame found in the second layer: `hit` there, not_traced elsewhere. Empty when the plan
/// has no hidden layer.
std::optional<TraceResult> read_hidden_hits(Gpu& gpu, const PreparedFrame& frame);
/// The second layer itself, of a frame whose plan has one.
GBufferImage read_second_layer(Gpu& gpu, const PreparedFrame& frame);
/// The image with this reflection in place of the traced one: colour and weight of each pixel, weight < 0 where nothing reflects.
/// Leaves this reflection in the shared buffers.
Image composite_reflection(Gpu& gpu, const PreparedFrame& frame, std::span<const glm::vec4> reflection);
/// What count_frame() needs. Until it is called, its pipelines are compiled beside whatever else is done.
struct PreparedCount;
using PreparedCountPtr = std::shared_ptr<const PreparedCount>;
PreparedCountPtr prepare_count(Gpu& gpu, const PreparedFrame& frame, Precision precision = Precision::float32);
TraceResult      count_frame(Gpu& gpu, PreparedFrame& frame, const PreparedCount& count);
/// Traces once with the counting pipeline (work counters on; never timed). Precision float64 gives the double twin.
TraceResult count_frame(Gpu& gpu, PreparedFrame& frame, Precision precision = Precision::float32);

} // namespace ssrlab
