// What lies behind the G-buffer's surfaces, where the walk asks for it.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& /*values*/)
{
    if (facts.layers == 1) return {PassDecision::off, "layers = 1"};
    if (!facts.scene) return {PassDecision::off, "no scene to draw again: layers as the frame came with them"};
    if (statistics.gbuffer.reflecting_pixels == 0) return {PassDecision::not_needed, "no pixel reflects"};
    return {PassDecision::needed, fmt::format("layers = {}", facts.layers)};
}

RecordFunction prepare(Gpu& /*gpu*/, const PassContext& context)
{
    return [&drawing = *context.frame.buffers->drawing, layers = context.frame.lab->settings.layers](
               const auto& commands) { record_layers(commands, drawing, layers); };
}

} // namespace

Pass layers_pass()
{
    return {.id      = "layers",
            .summary = "Draws the next surfaces behind the G-buffer's that face the camera, layer by layer",
            .cite    = {"C. Everitt 2001, Interactive Order-Independent Transparency"},
            .reads   = {Resource::gbuffer},
            .writes  = {Resource::layers},
            .decide  = decide,
            .prepare = prepare};
}

} // namespace ssrlab
