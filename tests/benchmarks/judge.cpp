#include "benchmarks/bench.h"
#include "benchmarks/visits_bound.h"
#include "compare/measures.h"
#include "harness/quality.h"
#include "truth/truth_cache.h"

#include <algorithm>
#include <filesystem>
#include <numeric>

namespace ssrlab {
namespace {

size_t count_traced(const TraceResult& result)
{
    return static_cast<size_t>(
        std::ranges::count_if(result.status, [](TraceStatus s) { return s != TraceStatus::not_traced; }));
}

size_t count_different(const TraceResult& a, const TraceResult& b, bool compare_t)
{
    size_t different = 0;
    for (size_t i = 0; i < a.status.size(); ++i) {
        const bool hit = a.status[i] == TraceStatus::hit;
        different += a.status[i] != b.status[i] ||
                     (hit && (a.hit_pixel[i] != b.hit_pixel[i] || (compare_t && a.hit_t[i] != b.hit_t[i])));
    }
    return different;
}

double percentile_99(std::vector<uint32_t> steps, const TraceResult& result)
{
    std::vector<uint32_t> traced;
    for (size_t i = 0; i < steps.size(); ++i)
        if (result.status[i] != TraceStatus::not_traced) traced.push_back(steps[i]);
    if (traced.empty()) return 0;
    const auto place = traced.begin() + static_cast<ptrdiff_t>(traced.size() * 99 / 100);
    std::ranges::nth_element(traced, place);
    return *place;
}

} // namespace

void Bench::judge(benchmark::State& state, const std::string& scene, glm::ivec2 size_px)
{
    Picture&         p    = picture(scene, size_px);
    const Judgement& work = judgement_of(p, contender("hiz"));
    for (auto _ : state) state.SetIterationTime(1e-9);
    state.counters["rays"]              = work.rays;
    state.counters["differs_from_walk"] = work.differs_from_walk;
    if (size_px.x > largest_judged_px) return;
    state.counters["differs_from_truth"] = work.differs_from_truth;
    state.counters["missed"]             = work.missed;
    state.counters["visits_bound"] =
        visits_with_perfect_cells(read_gbuffer(gpu_, *p.gbuffer), bench_settings.trace, truth_of(p), 7);
    state.counters["visits_per_ray"] = work.visits;
}

const TraceResult& Bench::truth_of(Picture& p)
{
    if (!p.truth)
        p.truth = cached_screen_truth(truth_cache_dir(std::filesystem::path(SSRLAB_SOURCE_DIR) / "results/bench"),
                                      read_gbuffer(gpu_, *p.gbuffer), bench_settings.trace);
    return *p.truth;
}

const TraceResult& Bench::walk_of(Picture& p)
{
    if (!p.walk) p.walk = count_frame(gpu_, frame_of(p, contender("dda")));
    return *p.walk;
}

const Judgement& Bench::judgement_of(Picture& p, const Contender& c)
{
    const auto [place, is_new] = p.judgements.try_emplace(c.name);
    Judgement& judged          = place->second;
    if (!is_new) return judged;
    const TraceResult result = count_frame(gpu_, frame_of(p, c));
    const auto        mean   = [&](const std::vector<uint32_t>& v) {
        return std::accumulate(v.begin(), v.end(), 0.0) / std::max(judged.rays, 1.0);
    };
    judged.rays       = static_cast<double>(count_traced(result));
    judged.visits     = mean(result.steps);
    judged.visits_p99 = percentile_99(result.steps, result);
    judged.fetches    = mean(result.depth_fetches) + mean(result.pyramid_fetches);
    if (c.name == "hiz") judged.differs_from_walk = static_cast<double>(count_different(result, walk_of(p), true));
    if (result.size_px.x > largest_judged_px) return judged;
    const MeasureValues measures = compare_to_screen_truth(result, truth_of(p));
    judged.recall                = measures.at("screen_recall_1px").value_or(0);
    judged.missed                = measures.at("screen_missed").value_or(0) * judged.rays;
    judged.differs_from_truth =
        static_cast<double>(count_different(result, truth_of(p), false)) / std::max(judged.rays, 1.0);
    return judged;
}

} // namespace ssrlab
