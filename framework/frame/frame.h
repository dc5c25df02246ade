// A frame turns hits into a picture: it plans the passes that it needs, compiles them, and runs them.
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

/// The defaults are those that measure best (docs/explanation/effects.md).
struct FrameSettings {
    TraceSettings   trace;
    std::string     reprojection = "plane";               // id of the strategy
    ParameterValues passes       = default_pass_values(); // of pass_parameters(), and those parameters of the strategy
                                                          // that are not at their default

    bool operator==(const FrameSettings&) const = default;
};

/// GPU times in milliseconds of the passes that ran, in their order.
struct FrameTimes {
    std::vector<std::pair<std::string, double>> passes_ms;

    double of(const std::string& pass) const; // 0 if it did not run
    double total_ms() const;
};

/// The light that comes back along a ray that something other than the frame answered (sources/).
struct RayLight {
    glm::vec3 light{0};        // linear radiance; undefined without a distance
    float     distance_m = -1; // from the reflecting point; +inf: it meets nothing; below 0: the frame answers
};

/// What a frame's own rays found, one entry per ray, pixel after pixel.
struct FrameRays {
    std::vector<RayInput>   rays;          // as the pass `rays` made them
    std::vector<RayOutcome> outcomes;      // without counts of work
    int                     per_pixel = 1; // rays of a pixel follow each other
};

/// Who answers a frame's rays: the frame alone, or also others, between trace_frame() and shade_frame().
enum class Answers : uint8_t { own, given };

/// What a pass moves at the least in one frame, if caches are ideal: each of its pixels or rays reads one item of every
/// buffer and image that its shaders read and writes one of those they write; once, whatever its dispatches share
/// (docs/reference/columns.md).
struct PassTraffic {
    std::string pass;
    uint64_t    read_bytes = 0, written_bytes = 0;
    uint64_t    instructions = 0; // of all invocations, a loop's once; 0 on a device that does not only compile
};
/// Returns the sum, as a pass called "frame".
PassTraffic sum_of(std::span<const PassTraffic> passes);
/// Returns the time that memory of this bandwidth needs for that, in milliseconds.
double least_ms(const PassTraffic& traffic, double bandwidth_gbps);

struct FrameBuffers; // targets of passes: allocated once per G-buffer, shared by all frames on it
struct ReadyFrame;   // the pipelines of one run

using FrameBuffersPtr = std::shared_ptr<FrameBuffers>;
using FramePtr        = std::shared_ptr<ReadyFrame>;

/// Return the targets of passes on a G-buffer. `drawing`: what draws it; null if it was made elsewhere.
FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer, const DrawingPtr& drawing = nullptr);
FrameBuffersPtr make_frame_buffers(Gpu& gpu, const DrawingPtr& drawing);

/// Returns the plan. Counts the G-buffer and, if passes depend on hits, traces once. `history`: what the frame before
/// left; null for a single frame. Throws SpecError for an unknown reprojection strategy.
FramePlan plan_frame(Gpu& gpu, const Catalogue& catalogue, const LabPtr& lab, const FrameBuffersPtr& buffers,
                     const FrameSettings& settings, const FrameHistoryPtr& history = nullptr);
/// Compiles the planned passes. Throws SpecError with file and line if the technique's shader does not compile.
FramePtr make_frame(Gpu& gpu, const LabPtr& lab, const FrameBuffersPtr& buffers, const FramePlan& plan,
                    const FrameHistoryPtr& history = nullptr, Answers answers = Answers::own);

/// A frame on a device that only compiles (gpu/compiled.h).
struct CompiledFrame {
    std::vector<CompiledPtr> pipelines;
    std::vector<PassTraffic> passes; // that run
    glm::ivec2               size_px{1920, 1080};
};
/// Compiles a frame in which every pixel reflects, half of them as mirrors and half with roughness 0.25, and every ray
/// hits. Passes that draw the scene are left out, since there is none.
CompiledFrame compile_frame(Gpu& gpu, const Catalogue& catalogue, const Technique& technique,
                            const ParameterValues& values, const FrameSettings& settings);

/// Runs the planned passes `frames` times in one submit, waits, and returns the times of the last. The first call
/// includes driver compilation: warm up.
FrameTimes run_frame(Gpu& gpu, ReadyFrame& frame, int frames = 1);
/// Returns what the passes of the last run_frame() moved.
std::vector<PassTraffic> count_traffic(Gpu& gpu, const ReadyFrame& frame);
/// Run a frame with Answers::given in two parts: all passes up to the trace, then the others. `answers`: one per ray,
/// or none, if the frame answers them all. `rays`: from trace_frame().
FrameTimes trace_frame(Gpu& gpu, ReadyFrame& frame, FrameRays& rays);
FrameTimes shade_frame(Gpu& gpu, ReadyFrame& frame, const FrameRays& rays, std::span<const RayLight> answers);
/// Returns the picture of the last run, linear RGB.
Image read_shaded(Gpu& gpu, const ReadyFrame& frame);
/// Returns what the last run_frame() found in the second layer: `hit`, else not_traced. nullopt if the plan has no
/// hidden layer.
std::optional<TraceImage> read_hidden_hits(Gpu& gpu, const ReadyFrame& frame);
/// Returns the second layer of a frame whose plan has one.
GBufferImage read_second_layer(Gpu& gpu, const ReadyFrame& frame);
/// Returns the picture with this reflection instead of the traced one: colour and weight per pixel, weight < 0 if
/// nothing reflects. Overwrites the reflection in the shared buffers.
Image composite_reflection(Gpu& gpu, const ReadyFrame& frame, std::span<const glm::vec4> reflection);

} // namespace ssrlab
