// Which tiles of the image reflect.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& /*values*/)
{
    const uint32_t tiles = statistics.gbuffer.reflecting_tiles;
    if (tiles == 0) return {PassDecision::not_needed, "no pixel reflects"};
    return {PassDecision::needed, fmt::format("{} of {} tiles reflect", tiles, statistics.tiles)};
}

RecordFunction prepare(Gpu& /*gpu*/, const PassContext& context)
{
    return [&frame = context.frame](const auto& commands) {
        record_classification(commands, frame.trace, *frame.lab->gbuffer);
    };
}

} // namespace

Pass classification_pass()
{
    return {.id      = "classification",
            .summary = "Lists the 8 x 8 pixel tiles that reflect; all later passes except composite run on these only",
            .reads   = {Resource::gbuffer},
            .writes  = {Resource::tiles},
            .decide  = decide,
            .prepare = prepare,
            .read_of_reflectors = {"material_image", "dielectric_image"}}; // of other surfaces, too: counted too low
}

} // namespace ssrlab
