// Single passes by GPU timestamps. Names: SCENE/SIZE/PASS or SCENE:VIEW/SIZE/PASS, e.g. thin_yard/1080p/copy_depth; choose with
// --benchmark_filter.
//   build/bin/benchmarks --scene=thin_yard --benchmark_filter=1080p
#include "benchmarks/bench.h"
#include "core/error.h"
#include "core/version.h"

#include <cstdio>

namespace ssrlab {
namespace {

struct PictureSize {
    std::string name;
    glm::ivec2  size_px;
    int         calls; // of a short pass: their mean is one repetition, so that noise meets it as it meets a long one
};
const std::vector<PictureSize> sizes = {
    {"360p", {640, 360}, 20}, {"720p", {1280, 720}, 10}, {"1080p", {1920, 1080}, 5}, {"2160p", {3840, 2160}, 2}};

template <typename Call> void add(const std::string& name, int iterations, const Call& call)
{
    benchmark::RegisterBenchmark(name.c_str(), call)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(iterations);
}

void add_all(Bench& bench, const std::string& scene)
{
    for (const PictureSize& size : sizes) {
        const int  calls = size.calls;
        const auto pass  = [&](const std::string& name, int iterations, auto run) {
            add(fmt::format("{}/{}/{}", scene, size.name, name), iterations,
                 [&bench, scene, size_px = size.size_px, run](auto& state) { run(bench, state, scene, size_px); });
        };
        pass("gbuffer", 1, [](auto& b, auto& state, auto&... picture) { b.gbuffer(state, picture...); });
        pass("copy_depth", calls, [](auto& b, auto& state, auto&... picture) { b.copy(state, picture...); });
        for (const std::string kind : {"occupancy", "minmax", "nearest"})
            pass("pyramid/" + kind, calls,
                 [kind](auto& b, auto& state, auto&... picture) { b.pyramid(state, picture..., kind); });
        pass("rays", calls, [](auto& b, auto& state, auto&... picture) { b.rays(state, picture...); });
        pass("trace", calls, [](auto& b, auto& state, auto&... picture) { b.trace(state, picture...); });
        pass("shade", calls, [](auto& b, auto& state, auto&... picture) { b.shade(state, picture...); });
        for (const bool compacted : {true, false})
            pass(compacted ? "scattered/list" : "scattered/every_pixel", calls,
                 [compacted](auto& b, auto& state, auto&... picture) { b.scattered(state, picture..., compacted); });
        pass("screen_truth", 1, [](auto& b, auto& state, auto&... picture) { b.screen_truth(state, picture...); });
        pass("scene_truth", 1, [](auto& b, auto& state, auto&... picture) { b.scene_truth(state, picture...); });
        pass("judge", 1, [](auto& b, auto& state, auto&... picture) { b.judge(state, picture...); });
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
                      tracer = take_option(arguments, "technique", "hiz_packets"),
                      scenes = take_option(arguments, "scene", "thin_yard,interior");
    std::string interleave   = "--benchmark_enable_random_interleaving=true";
    arguments.insert(arguments.begin() + 1, interleave.data()); // first, so that the caller can say otherwise
    auto count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) {
        std::fputs("also: --device=NAME_OR_INDEX --technique=NAME --scene=SCENE[:VIEW][,SCENE[:VIEW]…]\n", stderr);
        return 2;
    }
    Bench bench(device, tracer);
    benchmark::AddCustomContext("device", bench.info().name);
    benchmark::AddCustomContext("device_type", bench.info().type);
    benchmark::AddCustomContext("driver", bench.info().driver);
    benchmark::AddCustomContext("processor", bench.info().processor);
    benchmark::AddCustomContext("commit", built_commit());
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
