#include "benchmarks/bench.h"
#include "benchmarks/visits_bound.h"
#include "compare/differing_rays.h"
#include "compare/measures.h"
#include "core/files.h"
#include "harness/quality.h"
#include "truth/truth_cache.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>

namespace ssrlab {
namespace {

size_t count_traced(const TraceImage& result)
{
    return static_cast<size_t>(
        std::ranges::count_if(result.status, [](TraceStatus s) { return s != TraceStatus::not_traced; }));
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
    state.counters["differs_from_walk"] = static_cast<double>(count_differing_rays(result, walk));
    if (size_px.x > largest_judged_px) return;
    constexpr double   any_t   = std::numeric_limits<double>::infinity();
    const GBufferImage gbuffer = read_gbuffer(gpu_, *w.gbuffer);
    const TraceImage   truth =
        cached_screen_truth(truth_cache_dir(data_root() / "results/bench"), gbuffer, bench_settings.trace);
    const MeasureValues measures = compare_to_screen_truth(result, truth);
    state.counters["differs_from_truth"] =
        static_cast<double>(count_differing_rays(result, truth, any_t)) / std::max(rays, 1.0);
    state.counters["missed"] = measures.at("screen_missed").value_or(0) * rays;
    state.counters["visits_per_ray"] =
        std::accumulate(result.steps.begin(), result.steps.end(), 0.0) / std::max(rays, 1.0);
    state.counters["visits_bound"] = visits_with_perfect_cells(gbuffer, bench_settings.trace, truth, 7);
}

} // namespace ssrlab
