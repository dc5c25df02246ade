// Single passes by GPU timestamps. Names: SCENE/SIZE/PASS, e.g. thin_yard/1080p/trace/hiz; choose with --benchmark_filter.
//   build/bin/benchmarks --scene=thin_yard --benchmark_filter=1080p
#include "core/error.h"
#include "render/frame_passes.h"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <map>
#include <numeric>

namespace ssrlab {
namespace {

const std::map<std::string, glm::ivec2> sizes = {
    {"360p", {640, 360}}, {"720p", {1280, 720}}, {"1080p", {1920, 1080}}, {"2160p", {3840, 2160}}};

// Every ray sees the whole segment, so that all tracers answer the same question.
const FrameSettings settings{.trace = {.thickness_m = 0.1, .max_distance_m = 1e9}};

/// Marches have no metres to divide an unlimited ray by: they step in pixels.
ParameterValues values_for(const Technique& technique)
{
    ParameterValues values = default_values(technique);
    for (const Parameter& parameter : technique.parameters)
        for (size_t i = 0; i < parameter.choices.size(); ++i)
            if (parameter.name == "space" && parameter.choices[i] == "screen")
                values[parameter.name] = static_cast<double>(i);
    return values;
}

/// Means per ray, from one run of the counting pipeline.
struct Work {
    double rays = 0, visits = 0, fetches = 0;
};

Work count_work(Gpu& gpu, PreparedFrame& frame)
{
    const TraceResult result = count_frame(gpu, frame);
    const auto        sum    = [](const std::vector<uint32_t>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
    Work              work;
    for (const TraceStatus status : result.status) work.rays += status != TraceStatus::not_traced;
    if (work.rays == 0) return work;
    work.visits  = sum(result.steps) / work.rays;
    work.fetches = (sum(result.depth_fetches) + sum(result.pyramid_fetches)) / work.rays;
    return work;
}

/// What benchmarks of one picture share. Made when first used and kept: interleaved repetitions return to it.
struct Picture {
    GBufferPtr                              gbuffer;
    FrameBuffersPtr                         buffers;
    GpuImage                                copy;
    ComputePass                             copy_pass;
    Timestamps                              timestamps;
    std::map<std::string, PreparedFramePtr> frames; // by technique, or hiz's pyramid: "occupancy", "minmax", "nearest"
    std::map<std::string, Work>             work;   // by technique
};

class Bench {
public:
    explicit Bench(const std::string& device) : gpu_(open_gpu({.device = device})), techniques_(list_techniques({})) {}

    const std::vector<Technique>& techniques() const { return techniques_; }
    const GpuInfo&                info() const { return gpu_.info; }

    void gbuffer(benchmark::State& state, const std::string& scene, const std::string& size)
    {
        Picture& p = picture(scene, size);
        measure_calls(state, [&] { return rerender_gbuffer(gpu_, *p.gbuffer); });
    }

    void copy(benchmark::State& state, const std::string& scene, const std::string& size)
    {
        Picture& p = picture(scene, size);
        measure(state, p, [&](const auto& commands) { dispatch(commands, p.copy_pass, groups(p)); });
    }

    double pyramid_kind(const std::string& name) const
    {
        return parse_parameter(find_parameter(find_technique(techniques_, "hiz"), "pyramid", "benchmark"), name,
                               "benchmark");
    }

    void pyramid(benchmark::State& state, const std::string& scene, const std::string& size, const std::string& kind)
    {
        Picture&       p     = picture(scene, size);
        PreparedFrame& frame = frame_of(p, kind, "hiz", {{"pyramid", pyramid_kind(kind)}});
        measure(state, p, [&](const auto& commands) { record_pyramid(commands, frame.pyramid); });
    }

    void rays(benchmark::State& state, const std::string& scene, const std::string& size)
    {
        Picture&       p     = picture(scene, size);
        PreparedFrame& frame = frame_of(p, "dda", "dda", {});
        measure(state, p, [&](const auto& commands) { record_rays(commands, frame.trace, *p.buffers, *frame.rays); });
    }

    void trace(benchmark::State& state, const std::string& scene, const std::string& size, const std::string& id)
    {
        Picture&       p     = picture(scene, size);
        PreparedFrame& frame = frame_of(p, id, id, {});
        if (!p.work.contains(id)) p.work[id] = count_work(gpu_, frame);
        prepare_trace(p, frame);
        const double ms                   = measure(state, p, [&](const auto& commands) {
            dispatch_indirect(commands, frame.trace.trace, frame.rays->launch);
        });
        const Work&  work                 = p.work[id];
        state.counters["rays"]            = work.rays;
        state.counters["visits_per_ray"]  = work.visits;
        state.counters["fetches_per_ray"] = work.fetches;
        state.counters["ns_per_ray"]      = work.rays > 0 ? ms * 1e6 / work.rays : 0;
    }

    void shade(benchmark::State& state, const std::string& scene, const std::string& size)
    {
        Picture&       p     = picture(scene, size);
        PreparedFrame& frame = frame_of(p, "hiz", "hiz", {});
        prepare_trace(p, frame);
        submit(gpu_, [&](const auto& commands) { dispatch_indirect(commands, frame.trace.trace, frame.rays->launch); });
        const Recording hit_colour = make_recording(gpu_, frame, "hit_colour"),
                        composite  = make_recording(gpu_, frame, "composite");
        measure(state, p, [&](const auto& commands) {
            hit_colour(commands);
            barrier(commands);
            composite(commands);
        });
    }

private:
    Picture& picture(const std::string& scene, const std::string& size)
    {
        const auto [place, is_new] = pictures_.try_emplace(scene + size);
        Picture& p                 = place->second;
        if (!is_new) return p;
        if (!scenes_.contains(scene)) {
            const Scene loaded = load_scene(scene);
            scenes_[scene]     = {upload_scene(gpu_, loaded), find_camera(loaded, "default")};
        }
        p.gbuffer = render_gbuffer(gpu_, scenes_[scene].gpu, camera_to_view(scenes_[scene].camera, sizes.at(size)));
        p.buffers = make_frame_buffers(gpu_, p.gbuffer);
        p.copy    = make_image(
               gpu_,
               {.format = vk::Format::eR32Sfloat, .size_px = sizes.at(size), .usage = vk::ImageUsageFlagBits::eStorage});
        p.copy_pass  = make_compute_pass(gpu_, compile_shader({.file = "copy_depth.comp"}),
                                         {{"depth_image", p.gbuffer->depth}, {"depth_copy", p.copy}});
        p.timestamps = make_timestamps(gpu_, 2);
        return p;
    }

    /// Compiled, and run once so that the driver has compiled it, too.
    PreparedFrame& frame_of(Picture& p, const std::string& key, const std::string& id, const ParameterValues& changed)
    {
        if (!p.frames.contains(key)) {
            const Technique& technique = find_technique(techniques_, id);
            ParameterValues  values    = values_for(technique);
            for (const auto& [name, value] : changed) values.at(name) = value;
            p.frames[key] = prepare_frame(gpu_, p.buffers, technique, values, settings);
            run_frame(gpu_, *p.frames[key]);
        }
        return *p.frames[key];
    }

    static glm::uvec3 groups(const Picture& p)
    {
        const glm::ivec2 size = p.gbuffer->view.size_px;
        return {static_cast<uint32_t>(size.x + 7) / 8, static_cast<uint32_t>(size.y + 7) / 8, 1};
    }

    /// Rays and inputs in place: another benchmark may have used the buffers.
    void prepare_trace(Picture& p, PreparedFrame& frame)
    {
        submit(gpu_, [&](const auto& commands) {
            record_rays(commands, frame.trace, *p.buffers, *frame.rays);
            record_pyramid(commands, frame.pyramid);
        });
    }

    /// The mean of the state's iterations in milliseconds.
    template <typename Call> static double measure_calls(benchmark::State& state, const Call& call)
    {
        double total_ms = 0;
        call(); // the caches hold what the pass before this one left: one run brings this one's
        for (auto _ : state) {
            const double ms = call();
            total_ms += ms;
            state.SetIterationTime(ms * 1e-3);
        }
        return total_ms / static_cast<double>(state.iterations());
    }

    template <typename Record> double measure(benchmark::State& state, Picture& p, const Record& record)
    {
        return measure_calls(state, [&] {
            submit(gpu_, [&](const vk::raii::CommandBuffer& commands) {
                write_timestamp(commands, p.timestamps, 0);
                barrier(commands);
                record(commands);
                barrier(commands);
                write_timestamp(commands, p.timestamps, 1);
            });
            return read_intervals_ms(gpu_, p.timestamps)[0];
        });
    }

    struct LoadedScene {
        GpuScenePtr gpu;
        Camera      camera;
    };
    Gpu                                gpu_;
    std::vector<Technique>             techniques_;
    std::map<std::string, LoadedScene> scenes_;
    std::map<std::string, Picture>     pictures_;
};

template <typename Call> void add(const std::string& name, int iterations, const Call& call)
{
    benchmark::RegisterBenchmark(name.c_str(), call)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(iterations);
}

void add_all(Bench& bench, const std::string& scene)
{
    for (const auto& entry : sizes) {
        const std::string size = entry.first, base = scene + "/" + size + "/";
        add(base + "gbuffer", 1, [&bench, scene, size](auto& state) { bench.gbuffer(state, scene, size); });
        add(base + "copy_depth", 5, [&bench, scene, size](auto& state) { bench.copy(state, scene, size); });
        for (const std::string kind : {"occupancy", "minmax", "nearest"})
            add(base + "pyramid/" + kind, 5,
                [&bench, scene, size, kind](auto& state) { bench.pyramid(state, scene, size, kind); });
        add(base + "rays", 5, [&bench, scene, size](auto& state) { bench.rays(state, scene, size); });
        for (const Technique& t : bench.techniques())
            add(base + "trace/" + t.id, 1,
                [&bench, scene, size, id = t.id](auto& state) { bench.trace(state, scene, size, id); });
        add(base + "shade", 5, [&bench, scene, size](auto& state) { bench.shade(state, scene, size); });
    }
}

/// Takes "--NAME=VALUE" out of the arguments.
std::string take_option(std::vector<char*>& arguments, const std::string& name, const std::string& otherwise)
{
    const std::string prefix = "--" + name + "=";
    std::string       value  = otherwise;
    std::erase_if(arguments, [&](const char* argument) {
        const bool own = std::string(argument).starts_with(prefix);
        if (own) value = argument + prefix.size();
        return own;
    });
    return value;
}

int run(std::vector<char*> arguments)
{
    const std::string device = take_option(arguments, "device", ""),
                      scenes = take_option(arguments, "scene", "thin_yard,interior");
    std::string interleave   = "--benchmark_enable_random_interleaving=true";
    arguments.insert(arguments.begin() + 1, interleave.data()); // first, so that the caller can say otherwise
    auto count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) {
        std::fputs("also: --device=NAME_OR_INDEX --scene=SCENE[,SCENE…]\n", stderr);
        return 2;
    }
    Bench bench(device);
    benchmark::AddCustomContext("device", bench.info().name);
    benchmark::AddCustomContext("driver", bench.info().driver);
    for (size_t begin = 0; begin <= scenes.size();) {
        const size_t end = std::min(scenes.find(',', begin), scenes.size());
        add_all(bench, scenes.substr(begin, end - begin));
        begin = end + 1;
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

} // namespace
} // namespace ssrlab

int main(int argc, char** argv)
{
    try {
        return ssrlab::run({argv, argv + argc});
    } catch (const ssrlab::SpecError& error) {
        fmt::print(stderr, "benchmarks: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "benchmarks: {}\n", error.what());
        return 1;
    }
}
