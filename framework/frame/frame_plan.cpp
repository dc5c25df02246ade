#include "frame/frame_plan.h"

#include <fmt/format.h>

#include <algorithm>

namespace ssrlab {
namespace {

/// "roughness 0.00 to 0.47", from the borders of the histogram's bins.
std::string roughness_range(const GBufferCounts& counts)
{
    const auto present   = [](uint32_t pixels) { return pixels > 0; };
    const auto bin_of    = [](auto bin) { return static_cast<double>(bin) / (ROUGHNESS_BINS - 1); };
    const auto smoothest = std::ranges::find_if(counts.roughness_pixels, present);
    if (smoothest == counts.roughness_pixels.end()) return "nothing reflects";
    const auto roughest =
        std::ranges::find_if(counts.roughness_pixels.rbegin(), counts.roughness_pixels.rend(), present);
    const auto first = smoothest - counts.roughness_pixels.begin();
    const auto last  = counts.roughness_pixels.rend() - roughest - 1;
    return fmt::format("roughness {:.2f} to {:.2f}", first == 0 ? 0.0 : bin_of(first - 1), bin_of(last));
}

} // namespace

std::string percent(uint32_t part, uint32_t whole)
{
    return fmt::format("{:.3g} %", whole == 0 ? 0.0 : 100.0 * part / whole);
}

std::vector<PlannedPass> plan_passes(const FrameFacts& facts, const FrameStatistics& statistics,
                                     const ParameterValues& values)
{
    const bool               skips        = values.at("skip_unneeded_passes") != 0;
    const bool               shading_only = choice<PassSet>(values) == PassSet::shading;
    std::vector<PlannedPass> plan;
    for (const Pass& pass : all_passes()) {
        const PassDecision decision = pass.beyond_shading && shading_only
                                          ? PassDecision{PassDecision::off, "pass_set = shading"}
                                          : pass.decide(facts, statistics, values);
        const bool         runs =
            decision.verdict == PassDecision::needed || (decision.verdict == PassDecision::not_needed && !skips);
        if (!pass.per_structure || facts.structures.empty())
            plan.push_back({&pass, pass.id, runs, decision.reason});
        else
            for (const std::string& structure : facts.structures)
                plan.push_back({&pass, structure, runs, decision.reason});
    }
    return plan;
}

FramePlan unculled(FramePlan plan)
{
    plan.values.at("skip_unneeded_passes") = 0;
    plan.passes                            = plan_passes(plan.facts, plan.statistics, plan.values);
    plan.counting_s                        = 0;
    return plan;
}

bool skips_work(const FramePlan& plan)
{
    if (plan.values.at("skip_unneeded_passes") == 0 || choice<PassSet>(plan.values) == PassSet::shading) return false;
    const GBufferCounts& counts = plan.statistics.gbuffer;
    return counts.reflecting_pixels < counts.surface_pixels ||
           !std::ranges::equal(plan.passes, unculled(plan).passes, {}, &PlannedPass::runs, &PlannedPass::runs);
}

bool runs(const FramePlan& plan, std::string_view pass)
{
    return std::ranges::any_of(plan.passes, [&](const PlannedPass& row) { return row.id == pass && row.runs; });
}

std::vector<std::string> describe_facts(const FramePlan& plan)
{
    const FrameFacts&      facts      = plan.facts;
    const FrameStatistics& statistics = plan.statistics;
    const GBufferCounts&   gbuffer    = statistics.gbuffer;
    const TraceCounts&     trace      = statistics.trace;
    return {fmt::format("{} of {} pixels reflect ({}), in {} of {} tiles; {}{}", gbuffer.reflecting_pixels,
                        statistics.pixels, percent(gbuffer.reflecting_pixels, statistics.pixels),
                        gbuffer.reflecting_tiles, statistics.tiles, roughness_range(gbuffer), facts.reflectors),
            fmt::format("{} rays: {} hit a surface, {} of these a mirror", trace.rays, percent(trace.hits, trace.rays),
                        percent(trace.mirror_hits, trace.hits)),
            !facts.scene
                ? std::string("no scene: an imported G-buffer")
                : fmt::format("environment {}, {} alpha mask, {}", facts.environment_map ? "map" : "of one colour",
                              facts.alpha_mask ? "an" : "no", facts.motion)};
}

} // namespace ssrlab
