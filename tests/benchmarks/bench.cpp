#include "benchmarks/bench.h"

#include "core/error.h"
#include "core/files.h"
#include "core/stopwatch.h"
#include "scene/load_scene.h"
#include "truth/scene_truth.h"
#include "truth/screen_truth.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <numeric>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

double cpu_ms()
{
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

/// The mean of the state's iterations in milliseconds.
template <typename Call> double measure_calls(benchmark::State& state, const Call& call)
{
    double total_ms = 0;
    call(); // the caches hold what the pass before this one left: one run brings this one's
    const double cpu_before_ms = cpu_ms();
    for (auto _ : state) {
        const double ms = call();
        total_ms += ms;
        state.SetIterationTime(ms * 1e-3);
    }
    const auto count         = static_cast<double>(state.iterations());
    state.counters["cpu_ms"] = (cpu_ms() - cpu_before_ms) / count;
    return total_ms / count;
}

/// On all cores; no caches to warm. `steps`: what a truth counts.
template <typename Make> void measure_truth(benchmark::State& state, const std::string& steps, const Make& make)
{
    double       count         = 0;
    const double cpu_before_ms = cpu_ms();
    for (auto _ : state) {
        const Stopwatch stopwatch;
        count += make();
        state.SetIterationTime(stopwatch.seconds());
    }
    const double cpu                        = cpu_ms() - cpu_before_ms;
    state.counters["cpu_ms"]                = cpu / static_cast<double>(state.iterations());
    state.counters[steps + "_per_s_a_core"] = count / (cpu * 1e-3);
}

} // namespace

template <typename Record> double Bench::measure(benchmark::State& state, Workload& w, const Record& record)
{
    return measure_calls(state, [&] {
        submit(gpu_, [&](const Commands& commands) {
            write_timestamp(commands, w.timestamps, 0);
            barrier(commands);
            record(commands);
            barrier(commands);
            write_timestamp(commands, w.timestamps, 1);
        });
        return read_intervals_ms(gpu_, w.timestamps)[0];
    });
}

Bench::Bench(const std::string& device, const std::string& tracer)
    : gpu_(open_gpu({.device = device})),
      catalogue_(load_catalogue(std::vector<fs::path>{data_root() / "techniques/rivals"})),
      tracer_{find_technique(catalogue_.techniques, tracer).id, {}}
{
}

void Bench::gbuffer(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Workload& w = workload(scene, size_px);
    measure_calls(state, [&] { return redraw_gbuffer(gpu_, *w.drawing); });
}

void Bench::copy(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Workload& w = workload(scene, size_px);
    measure(state, w, [&](const auto& commands) { dispatch(commands, w.copy_pass, groups_of_8(size_px)); });
}

void Bench::pyramid(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, const std::string& kind)
{
    Workload&   w     = workload(scene, size_px);
    ReadyFrame& frame = frame_of(w, {tracer_.technique, {{"depth_pyramid.kind", kind}}});
    measure(state, w, [&](const auto& commands) { record_depth_structures(commands, *frame.inputs.lab); });
}

void Bench::rays(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Workload&   w     = workload(scene, size_px);
    ReadyFrame& frame = frame_of(w, tracer_);
    measure(state, w, [&](const auto& commands) { record_rays(commands, frame.inputs.trace, *w.gbuffer); });
}

void Bench::trace(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Workload&   w     = workload(scene, size_px);
    ReadyFrame& frame = frame_of(w, tracer_);
    prepare_trace(frame);
    measure(state, w, [&](const auto& commands) {
        record_technique(commands, frame.inputs.trace.technique, *frame.inputs.rays);
    });
}

void Bench::shade(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Workload&   w     = workload(scene, size_px);
    ReadyFrame& frame = frame_of(w, tracer_);
    prepare_trace(frame);
    submit(gpu_,
           [&](const auto& commands) { record_technique(commands, frame.inputs.trace.technique, *frame.inputs.rays); });
    const auto           prepared = [&](const Pass& pass) { return pass.prepare(gpu_, {frame.inputs, pass, pass.id}); };
    const RecordFunction hit_colour = prepared(hit_colour_pass()), composite = prepared(composite_pass());
    measure(state, w, [&](const auto& commands) {
        hit_colour(commands);
        barrier(commands);
        composite(commands);
    });
}

void Bench::scattered(benchmark::State& state, const std::string& scene, glm::ivec2 size_px, bool compacted)
{
    Workload& w = workload(scene, size_px);
    if (!w.scattered) w.scattered = scatter(w);
    Scattered& s = *w.scattered;
    prepare_trace(*s.frame);
    measure(state, w, [&](const auto& commands) {
        if (compacted)
            record_technique(commands, s.frame->inputs.trace.technique, *s.frame->inputs.rays);
        else
            record_technique(commands, s.over_every_pixel.technique, s.every_pixel);
    });
    state.counters["rays"] = static_cast<double>(s.frame->inputs.rays->capacity);
}

void Bench::screen_truth(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    const GBufferImage gbuffer = read_gbuffer(gpu_, *workload(scene, size_px).gbuffer);
    measure_truth(state, "cells", [&] {
        const TraceImage truth = ssrlab::screen_truth(gbuffer, bench_settings.trace);
        return std::accumulate(truth.steps.begin(), truth.steps.end(), 0.0);
    });
}

void Bench::scene_truth(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    const GBufferImage gbuffer = read_gbuffer(gpu_, *workload(scene, size_px).gbuffer);
    const Scene&       loaded  = scenes_[scene].scene;
    const SceneBvh     bvh(loaded);
    measure_truth(state, "rays", [&] {
        const SceneTruth truth = ssrlab::scene_truth(bvh, loaded, gbuffer, bench_settings.trace);
        return static_cast<double>(
            std::ranges::count_if(truth.cls, [](TruthClass c) { return c != TruthClass::not_traced; }));
    });
}

Bench::Workload& Bench::workload(const std::string& scene, glm::ivec2 size_px)
{
    const auto [place, is_new] = workloads_.try_emplace(fmt::format("{} {}x{}", scene, size_px.x, size_px.y));
    Workload& w                = place->second;
    if (!is_new) return w;
    if (!scenes_.contains(scene)) {
        const size_t colon  = scene.find_last_of(':');
        const bool   viewed = colon != std::string::npos && !scene.starts_with("builtin:");
        LoadedScene& loaded = scenes_[scene];
        loaded.scene        = load_scene(viewed ? scene.substr(0, colon) : scene);
        loaded.gpu          = upload_scene(gpu_, loaded.scene);
        loaded.camera       = find_camera(loaded.scene, viewed ? scene.substr(colon + 1) : "default");
    }
    w.drawing = draw_gbuffer(gpu_, scenes_[scene].gpu, camera_to_view(scenes_[scene].camera, size_px));
    w.gbuffer = w.drawing->gbuffer;
    w.buffers = make_frame_buffers(gpu_, w.drawing);
    for (GpuImage* image : {&w.depth, &w.copy}) *image = make_storage_image(gpu_, vk::Format::eR32Sfloat, size_px);
    const std::vector<float> depth = read_depth(gpu_, w.gbuffer->depth);
    upload(gpu_, w.depth, depth.data(), depth.size() * sizeof(float));
    w.copy_pass =
        make_compute_pass(gpu_, compile_shader(gpu_, {.file = data_root() / "tests/benchmarks/copy_depth.comp"}),
                          {{"depth_image", w.depth}, {"depth_copy", w.copy}});
    w.timestamps = make_timestamps(gpu_, 2);
    return w;
}

/// Compiled, and run once so that the driver has compiled it, too.
ReadyFrame& Bench::frame_of(Workload& w, const Contender& c)
{
    FramePtr& frame = w.frames[c];
    if (!frame) {
        const Technique& technique = find_technique(catalogue_.techniques, c.technique);
        ParameterValues  values    = default_values(technique);
        for (const auto& [name, text] : c.values)
            values.at(name) = parse_parameter(find_parameter(technique, name, "benchmark"), text, "benchmark");
        const LabPtr lab = make_lab(gpu_, catalogue_, w.gbuffer, technique, values, bench_settings.trace);
        frame = make_frame(gpu_, lab, w.buffers, plan_frame(gpu_, catalogue_, lab, w.buffers, bench_settings));
        run_frame(gpu_, *frame);
    }
    return *frame;
}

/// Rays and structures in place: another benchmark may have used the buffers.
void Bench::prepare_trace(const ReadyFrame& frame)
{
    submit(gpu_, [&](const auto& commands) {
        record_rays(commands, frame.inputs.trace, *frame.inputs.lab->gbuffer);
        record_depth_structures(commands, *frame.inputs.lab);
    });
}

} // namespace ssrlab
