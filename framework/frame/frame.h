// What a frame does with hits: it plans which passes it needs, compiles them, and runs them.
//
//     FramePlan  plan  = plan_frame(gpu, catalogue, lab, buffers, settings); // traces once where passes depend on hits
//     FramePtr   frame = make_frame(gpu, lab, buffers, plan);
//     FrameTimes times = run_frame(gpu, *frame);
//     Image      image = read_shaded(gpu, *frame);
#pragma once

#include "core/image.h"
#include "frame/frame_history.h"
#include "frame/frame_plan.h"
#include "frame/scene_pictures.h"
#include "gpu/compiled.h"

#include <utility>

namespace ssrlab {

/// A frame's defaults are what measures best (docs/explanation/surfaces.md); TraceSettings alone are the simplest contract.
struct FrameSettings {
    TraceSettings   trace        = {.behind = Behind::stop, .surface = "plane_solid"};
    std::string     reprojection = "plane";         // id of the strategy
    ParameterValues passes = default_pass_values(); // by the names of pass_parameters(), and of the strategy's own
                                                    // parameters those that are not at their default

    bool operator==(const FrameSettings&) const = default;
};

/// Milliseconds by GPU timestamps, of the passes that ran, in their order.
struct FrameTimes {
    std::vector<std::pair<std::string, double>> passes_ms;

    double of(const std::string& pass) const; // 0 when it did not run
    double total_ms() const;
};

struct FrameBuffers; // what passes write: allocated once per G-buffer, shared by all frames on it
struct ReadyFrame;   // the pipelines of one run

using FrameBuffersPtr = std::shared_ptr<FrameBuffers>;
using FramePtr        = std::shared_ptr<ReadyFrame>;

/// drawing: what draws the G-buffer; null: it was made elsewhere.
FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer, const DrawingPtr& drawing = nullptr);
FrameBuffersPtr make_frame_buffers(Gpu& gpu, const DrawingPtr& drawing);

/// Counts the G-buffer and, if passes depend on hits, traces once. history: what the frame before left, or null for a
/// single frame. Throws SpecError for a reprojection strategy that the catalogue lacks.
FramePlan plan_frame(Gpu& gpu, const Catalogue& catalogue, const LabPtr& lab, const FrameBuffersPtr& buffers,
                     const FrameSettings& settings, const FrameHistoryPtr& history = nullptr);
/// Compiles what the plan needs. Throws SpecError with the technique's file and line when its shader does not compile.
FramePtr make_frame(Gpu& gpu, const LabPtr& lab, const FrameBuffersPtr& buffers, const FramePlan& plan,
                    const FrameHistoryPtr& history = nullptr);

/// On a device that only compiles (gpu/compiled.h): every pipeline of a frame at 1080p, as if every pixel reflected, one
/// half of them as mirrors and one half with a roughness of a quarter, and every ray hit. There is no scene: what draws
/// it is left out.
std::vector<CompiledPtr> compile_frame(Gpu& gpu, const Catalogue& catalogue, const Technique& technique,
                                       const ParameterValues& values, const FrameSettings& settings);

/// Runs the planned passes and waits. The first call of a frame includes driver compilation: warm up.
/// frames: so many times, one after another, in one submit. The times are those of the last.
FrameTimes run_frame(Gpu& gpu, ReadyFrame& frame, int frames = 1);
/// The image that the last run_frame of this frame left in the shared buffers. Linear RGB.
Image read_shaded(Gpu& gpu, const ReadyFrame& frame);
/// What the last run_frame of this frame found in the second layer: `hit` there, not_traced elsewhere. Empty when the
/// plan has no hidden layer.
std::optional<TraceResult> read_hidden_hits(Gpu& gpu, const ReadyFrame& frame);
/// The second layer itself, of a frame whose plan has one.
GBufferImage read_second_layer(Gpu& gpu, const ReadyFrame& frame);
/// The image with this reflection in place of the traced one: colour and weight of each pixel, weight < 0 where nothing
/// reflects. Leaves this reflection in the shared buffers.
Image composite_reflection(Gpu& gpu, const ReadyFrame& frame, std::span<const glm::vec4> reflection);

} // namespace ssrlab
