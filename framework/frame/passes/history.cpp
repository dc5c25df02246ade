// The reflection accumulated over the frames.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {

PassDecision needed_after_a_frame(const FrameFacts& facts)
{
    if (facts.history.state.empty()) return {PassDecision::off, "a single frame: no history"};
    if (!facts.history.usable) return {PassDecision::off, facts.history.state};
    if (!facts.history.changes) return {PassDecision::not_needed, facts.history.state + ": the frame before once more"};
    return {PassDecision::needed, facts.history.state};
}

PassDecision needed_for_history(const FrameFacts& facts, const FrameStatistics& statistics,
                                const ParameterValues& values)
{
    if (values.at("history_weight") == 0) return {PassDecision::off, "history_weight = 0"};
    const PassDecision after = needed_after_a_frame(facts);
    if (after.verdict != PassDecision::off && statistics.gbuffer.reflecting_pixels == 0)
        return {PassDecision::not_needed, "no pixel reflects"};
    return after;
}

namespace {

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    Defines defines;
    if (trace_block_px(context.frame.plan.values) > 1) defines.emplace("BLOCKS", "1");
    const FrameHistory& history = *context.frame.history;
    const GpuImage&     into    = image_of(context, Resource::filtered);
    // Beside a reflector the pass writes nothing, and the next frame may still ask there.
    const glm::uvec4 unknown = glm::floatBitsToUint(glm::vec4(1, 0, -1, 0));
    return
        [pass = make_shared_pass(gpu, context, "passes/history.comp", defines), &history, &filtered = into,
         fills  = std::array{make_reflection_fill(gpu, into), make_reflection_fill(gpu, history.kept_reflection),
                            make_fill(gpu, history.kept_facts, unknown)},
         &tiles = tile_launch(context), &reflection = image_of(context, Resource::reflection)](const auto& commands) {
            for (const RecordFunction& fill : fills) fill(commands);
            record_fill(commands, history.counts, 0);
            barrier(commands);
            dispatch_indirect(commands, *pass, tiles);
            record_copy(commands, filtered, reflection);
        };
}

} // namespace

Pass history_pass()
{
    return {
        .id      = "history",
        .summary = "Accumulates the reflection over the frames of a sequence",
        .cite    = {"B. Karis 2014, High-Quality Temporal Supersampling",
                    "M. Salvi 2016, An Excursion in Temporal Supersampling"},
        .reads   = {Resource::gbuffer, Resource::objects, Resource::tiles, Resource::block_pixel, Resource::reflection,
                    Resource::reprojected, Resource::history},
        .writes  = {Resource::filtered, Resource::reflection, Resource::kept},
        .parameters     = {real_parameter("history_weight", 0.9, 0, 0.999,
                                          "weight of the frames before in the accumulated reflection, once there are "
                                              "enough for it; 0: no history"),
                           choice_parameter(HistoryClamping::minmax,
                                            "history is clamped to what the 3 x 3 pixels around hold now: off, between the "
                                                "smallest and largest value, or mean ± deviations"),
                           real_parameter("clamping_deviations", 1, 0, 16,
                                          "standard deviations on each side with history_clamping = variance"),
                           real_parameter("reject_depth", 0.05, 0, 1e6,
                                          "no history where another surface was: the largest difference in distance "
                                              "between the reflector's plane and what was there, as a share; 0: all is taken"),
                           real_parameter("reject_normal", 0.9, -1, 1,
                                          "no history where the reflector's normal and the one that was there have a "
                                              "smaller cosine; -1: all is taken"),
                           boolean_parameter("reject_hit", false,
                                             "no history where the reflector showed another object than it does now"),
                           real_parameter("hit_distance_tolerance", 0, 0, 1e6,
                                          "difference between the ray's length now and then, as a share, at which the "
                                              "history's weight falls to 1/e; 0: lengths do not count")},
        .decide         = needed_for_history,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
