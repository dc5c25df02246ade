// The depth pyramid, for techniques that read it.
#include "render/passes/pass_helpers.h"

#include <algorithm>

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (std::ranges::count(facts.inputs, "depth_pyramid") == 0)
        return {PassDecision::off, "the technique does not read it"};
    return needed_if_anything_reflects(facts, statistics, values);
}

RecordFunction prepare(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_pyramid(commands, frame.pyramid); };
}

} // namespace

Pass depth_pyramid_pass()
{
    return {.id      = "depth_pyramid",
            .summary = "Reduces depth level by level, and to planes of patches where the technique reads beams",
            .decide  = decide,
            .prepare = prepare};
}

} // namespace ssrlab
