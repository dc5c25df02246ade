// The structures that the technique reads, such as the depth pyramid: each under its own id.
#include "frame/passes/pass_helpers.h"

#include <algorithm>

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (facts.structures.empty()) return {PassDecision::off, "the technique reads none"};
    return needed_if_anything_reflects(facts, statistics, values);
}

RecordFunction prepare(Gpu& /*gpu*/, const PassContext& context)
{
    return [&frame = context.frame, id = context.id](const auto& commands) {
        const auto             own       = [&](const StructurePasses& passes) { return passes.id == id; };
        const TechniquePasses& technique = frame.trace.technique;
        record_structure(commands, *std::ranges::find_if(frame.lab->structures, own), nullptr);
        record_structure(commands, *std::ranges::find_if(technique.structures, own), &frame.rays->group_launch);
    };
}

} // namespace

Pass structures_pass()
{
    return {.id            = "structures",
            .summary       = "Builds what the technique reads beside depth, such as the depth pyramid",
            .reads         = {Resource::gbuffer, Resource::layers, Resource::solids, Resource::rays},
            .writes        = {Resource::structures},
            .decide        = decide,
            .prepare       = prepare,
            .per_structure = true};
}

} // namespace ssrlab
