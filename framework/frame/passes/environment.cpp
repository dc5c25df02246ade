// The environment where rays missed.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("environment_fallback") == 0) return {PassDecision::off, "environment_fallback = false"};
    if (!facts.scene) return {PassDecision::off, "an imported G-buffer has no environment"};
    const TraceCounts& trace = statistics.trace;
    if (statistics.gbuffer.reflecting_pixels == 0) return {PassDecision::not_needed, "no pixel reflects"};
    if (draws_lobe_rays(values)) return {PassDecision::not_needed, "gloss = stochastic: each ray looks it up"};
    if (trace.hits < trace.rays)
        return {PassDecision::needed,
                fmt::format("{} of the rays missed", percent(trace.rays - trace.hits, trace.rays))};
    for (const char* fade : {"viewer_fade", "edge_fade", "depth_step_fade_m", "base_colour_min_weight"})
        if (values.at(fade) != 0) return {PassDecision::needed, fmt::format("{} blends into it", fade)};
    if (values.at("min_direction_cosine") > -1) return {PassDecision::needed, "min_direction_cosine may reject hits"};
    return {PassDecision::not_needed, "every ray hit, and nothing fades"};
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    Defines  defines;
    Bindings bindings;
    add_environment(gpu, context, defines, bindings);
    auto pass = std::make_shared<ComputePass>(make_pass(gpu, context, "passes/environment.comp", defines, bindings));
    return [&tiles = tile_launch(context), pass](const auto& commands) { dispatch_indirect(commands, *pass, tiles); };
}

} // namespace

Pass environment_pass()
{
    return {
        .id             = "environment",
        .summary        = "Adds the light from infinitely far away where rays missed or their hits fade",
        .reads          = {Resource::gbuffer, Resource::surroundings, Resource::tiles, Resource::reflection},
        .writes         = {Resource::reflection},
        .parameters     = {boolean_parameter("environment_fallback", true,
                                             "use the environment where a ray missed: its map, or the background colour")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
