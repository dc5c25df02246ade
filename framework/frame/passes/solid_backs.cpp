// Where solids end, for the surface model that asks.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& /*values*/)
{
    if (!facts.solids) return {PassDecision::off, "the surface model has no solids"};
    if (!facts.scene) return {PassDecision::off, "no scene to draw again: solids as the frame came with them"};
    if (statistics.gbuffer.reflecting_pixels == 0) return {PassDecision::not_needed, "no pixel reflects"};
    return {PassDecision::needed, "the surface model has solids"};
}

RecordFunction prepare(Gpu& /*gpu*/, const PassContext& context)
{
    return [&drawing = *context.frame.buffers->drawing,
            layers   = context.frame.lab->settings.layers](const auto& commands) {
        record_solid_backs(commands, drawing);
        for (int i = 0; i + 1 < layers; ++i) record_solid_backs(commands, *drawing.layers[static_cast<size_t>(i)]);
    };
}

} // namespace

Pass solid_backs_pass()
{
    return {.id      = "solid_backs",
            .summary = "Draws the nearest surface behind each of the G-buffer's layers, to know where solids end",
            .cite    = {"D. Gustafsson 2017, Screen space path tracing (Voxagon blog)"},
            .reads   = {Resource::gbuffer, Resource::layers},
            .writes  = {Resource::solids},
            .decide  = decide,
            .prepare = prepare};
}

} // namespace ssrlab
