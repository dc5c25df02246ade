#include "benchmarks/bench.h"
#include "benchmarks/visits_bound.h"
#include "compare/measures.h"
#include "core/files.h"
#include "harness/quality.h"
#include "truth/truth_cache.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

namespace ssrlab {
namespace {

size_t count_traced(const TraceImage& result)
{
    return static_cast<size_t>(
        std::ranges::count_if(result.status, [](TraceStatus s) { return s != TraceStatus::not_traced; }));
}

size_t count_different(const TraceImage& a, const TraceImage& b, bool compare_t)
{
    size_t different = 0;
    for (size_t i = 0; i < a.status.size(); ++i) {
        const bool hit = a.status[i] == TraceStatus::hit;
        different += a.status[i] != b.status[i] ||
                     (hit && (a.hit_pixel[i] != b.hit_pixel[i] || (compare_t && a.hit_t[i] != b.hit_t[i])));
    }
    return different;
}

} // namespace

void Bench::judge(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Workload&        w      = workload(scene, size_px);
    const TraceImage result = trace_gbuffer(gpu_, *make_tracer(gpu_, frame_of(w, tracer_).inputs.lab));
    const TraceImage walk   = trace_gbuffer(gpu_, *make_tracer(gpu_, frame_of(w, {"dda", {}}).inputs.lab));
    const double     rays   = static_cast<double>(count_traced(result));
    for (auto _ : state) state.SetIterationTime(1e-9);
    state.counters["rays"]              = rays;
    state.counters["differs_from_walk"] = static_cast<double>(count_different(result, walk, true));
    if (size_px.x > largest_judged_px) return;
    const GBufferImage gbuffer = read_gbuffer(gpu_, *w.gbuffer);
    const TraceImage   truth =
        cached_screen_truth(truth_cache_dir(data_root() / "results/bench"), gbuffer, bench_settings.trace);
    const MeasureValues measures = compare_to_screen_truth(result, truth);
    state.counters["differs_from_truth"] =
        static_cast<double>(count_different(result, truth, false)) / std::max(rays, 1.0);
    state.counters["missed"] = measures.at("screen_missed").value_or(0) * rays;
    state.counters["visits_per_ray"] =
        std::accumulate(result.steps.begin(), result.steps.end(), 0.0) / std::max(rays, 1.0);
    state.counters["visits_bound"] = visits_with_perfect_cells(gbuffer, bench_settings.trace, truth, 7);
}

} // namespace ssrlab
