// The passes of a frame one by one, on pictures that are made once and kept: interleaved repetitions return to them.
#pragma once

#include "frame/frame_inputs.h"

#include <benchmark/benchmark.h>

#include <optional>
#include <tuple>

namespace ssrlab {

/// Every ray sees the whole segment, so that all tracers answer the same question.
inline const FrameSettings bench_settings{
    .trace = boxes({.thickness_m = 0.1, .max_distance_m = 1e9, .dielectric_min_f0 = 1})}; // only metals reflect
inline constexpr int largest_judged_px = 1920; // the truth of a larger picture takes minutes

/// A technique with some values changed.
struct Contender {
    std::string                        technique;
    std::map<std::string, std::string> values;

    bool operator<(const Contender& b) const { return std::tie(technique, values) < std::tie(b.technique, b.values); }
};

class Bench {
public:
    /// tracer: the technique that is judged, and whose structures and rays the passes use.
    Bench(const std::string& device, const std::string& tracer);

    const GpuInfo& info() const { return gpu_.info; }

    void gbuffer(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void copy(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void pyramid(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, const std::string& kind);
    void rays(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void trace(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void shade(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    /// The tracer where a pixel of 16 reflects, scattered: the list of these rays, or an invocation for each pixel.
    void scattered(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, bool compacted);
    /// The truths on the CPU, made anew each time: pixels and rays a second and core.
    void screen_truth(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void scene_truth(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    /// No time: how the tracer compares with the pixel walk and the screen truth, and the visits of perfect cells.
    void judge(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);

private:
    struct Scattered {
        GBufferPtr      gbuffer;
        FrameBuffersPtr buffers;
        FramePtr        frame;
        RayBuffers      every_pixel; // rays of length 0 where nothing reflects
        TracePasses     over_every_pixel;
    };
    struct Workload {
        DrawingPtr                    drawing;
        GBufferPtr                    gbuffer;
        FrameBuffersPtr               buffers;
        GpuImage                      depth, copy; // R32F
        ComputePass                   copy_pass;
        Timestamps                    timestamps;
        std::map<Contender, FramePtr> frames;
        std::optional<Scattered>      scattered;
    };
    struct LoadedScene {
        Scene       scene;
        GpuScenePtr gpu;
        Camera      camera;
    };

    Workload&                         workload(const std::string& scene, glm::ivec2 size_px);
    ReadyFrame&                       frame_of(Workload& workload, const Contender& contender);
    Scattered                         scatter(Workload& workload);
    void                              prepare_trace(const ReadyFrame& frame);
    template <typename Record> double measure(benchmark::State& state, Workload& workload, const Record& record);

    Gpu                                gpu_;
    Catalogue                          catalogue_;
    Contender                          tracer_;
    std::map<std::string, LoadedScene> scenes_;
    std::map<std::string, Workload>    workloads_;
};

} // namespace ssrlab
