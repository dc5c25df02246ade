// The passes of a frame one by one, on pictures that are made once and kept: interleaved repetitions return to them.
#pragma once

#include "render/frame_passes.h"
#include "scene/scene.h"

#include <benchmark/benchmark.h>

#include <optional>

namespace ssrlab {

/// Every ray sees the whole segment, so that all tracers answer the same question.
inline const FrameSettings bench_settings{.trace = {.thickness_m = 0.1, .max_distance_m = 1e9}};
inline constexpr int       largest_judged_px = 1920; // the truth of a larger picture takes minutes

/// A technique with some values changed, under a name of its own.
struct Contender {
    std::string                        name, technique;
    std::map<std::string, std::string> values;
};

/// How a contender compares with the screen truth and with the pixel walk, and its work per ray.
struct Judgement {
    double rays = 0, visits = 0, visits_p99 = 0, fetches = 0;
    double recall = 0, differs_from_truth = 0, missed = 0; // of the screen truth's rays; up to 1080p
    double differs_from_walk = 0;                          // rays whose status, pixel or t differ from dda's
};

class Bench {
public:
    explicit Bench(const std::string& device);

    const GpuInfo&                info() const { return gpu_.info; }
    const std::vector<Contender>& contenders() const { return contenders_; }
    /// Else it passes pixel by pixel.
    bool reads_pyramid(const Contender& contender) const;

    void gbuffer(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void copy(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void pyramid(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, const std::string& kind);
    void rays(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void trace(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, const Contender& contender);
    void shade(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    /// hiz where one pixel of 16 reflects, here and there: the list of these rays, or one invocation for every pixel.
    void scattered(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, bool compacted);
    /// The truths on the CPU, made anew each time: pixels and rays a second and core.
    void screen_truth(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    void scene_truth(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);
    /// No time: how hiz compares with the truths, and the visits of perfect cells.
    void judge(benchmark::State& state, const std::string& scene, glm::ivec2 size_px);

private:
    struct Scattered {
        GBufferPtr       gbuffer;
        FrameBuffersPtr  buffers;
        PreparedFramePtr frame;
        RayBuffers       every_pixel; // rays of length 0 where nothing reflects
        TracePasses      over_every_pixel;
    };
    struct Picture {
        GBufferPtr                              gbuffer;
        FrameBuffersPtr                         buffers;
        GpuImage                                depth, copy; // R32F
        ComputePass                             copy_pass;
        Timestamps                              timestamps;
        std::map<std::string, PreparedFramePtr> frames; // by contender
        std::map<std::string, Judgement>        judgements;
        std::optional<TraceResult>              truth, walk;
        std::optional<Scattered>                scattered;
    };
    struct LoadedScene {
        Scene       scene;
        GpuScenePtr gpu;
        Camera      camera;
    };

    Picture&                          picture(const std::string& scene, glm::ivec2 size_px);
    const Contender&                  contender(const std::string& name) const;
    PreparedFrame&                    frame_of(Picture& picture, const Contender& contender);
    const TraceResult&                truth_of(Picture& picture);
    const TraceResult&                walk_of(Picture& picture);
    const Judgement&                  judgement_of(Picture& picture, const Contender& contender);
    Scattered                         scatter(Picture& picture);
    void                              prepare_trace(const FrameBuffers& buffers, PreparedFrame& frame);
    template <typename Record> double measure(benchmark::State& state, Picture& picture, const Record& record);

    Gpu                                gpu_;
    std::vector<Technique>             techniques_;
    std::vector<Contender>             contenders_;
    std::map<std::string, LoadedScene> scenes_;
    std::map<std::string, Picture>     pictures_;
};

} // namespace ssrlab
