// Where each reflection was in the frame before.
#include "trace/reprojection.h"
#include "frame/layers.h"
#include "frame/passes/pass_helpers.h"

#include <algorithm>
#include <limits>

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    const PassDecision bounces = bounces_pass().decide(facts, statistics, values);
    if (takes_bounces_from_history(facts, values) && bounces.verdict == PassDecision::needed)
        return {PassDecision::needed, "bounces come from the frame before"};
    return needed_for_history(facts, statistics, values);
}

RecordFunction prepare(Gpu& gpu, PreparedFrame& frame)
{
    const Reprojection&    strategy = chosen_reprojection(frame.settings.passes);
    ShaderSource           source{.file = "passes/reprojection.comp", .include_folders = {strategy.folder}};
    std::vector<Parameter> bare = strategy.parameters;
    for (Parameter& parameter : bare) parameter.name.erase(0, strategy.id.size() + 1);
    source.include_texts = {{"reprojection/parameters", parameter_declarations(bare, CONSTANT_REPROJECTION)}};
    source.include_files = {{"reprojection/reproject.glsl", strategy.folder / "reproject.glsl"}};
    Bindings more        = history_bindings(*frame.history, frame.motion, *frame.buffers->gbuffer);
    source.defines.emplace("LAYERS", std::to_string(frame.hidden_layer ? 2 : frame.settings.trace.layers));
    if (draws_lobe_rays(frame.settings.passes)) source.defines.emplace("LOBE_RAYS", "1");
    add_layers(more, frame.hidden_layer ? std::span<const GBufferPtr>(&frame.buffers->second_layer, 1)
                                        : std::span<const GBufferPtr>(frame.buffers->gbuffer->layers));
    auto pass = std::make_shared<ComputePass>(make_composed_pass(gpu, frame, source, more, strategy.parameters));
    return [&frame, pass](const auto& commands) {
        constexpr float nan = std::numeric_limits<float>::quiet_NaN();
        record_clear(commands, frame.history->reprojected, {std::array<float, 4>{nan, nan, 0, -1}});
        dispatch_indirect(commands, *pass, frame.rays->launch);
    };
}

std::vector<Parameter> parameters()
{
    std::vector<std::string> ids;
    for (const Reprojection& strategy : all_reprojections()) ids.push_back(strategy.id);
    const auto fallback = std::ranges::find(ids, "plane") - ids.begin();
    return {{.name          = "reprojection",
             .type          = ParameterType::choice,
             .default_value = static_cast<double>(fallback),
             .max           = static_cast<double>(ids.size()) - 1,
             .choices       = ids,
             .doc = "where a reflection was in the frame before: a folder with reprojection.toml, see docs/explanation/motion.md"}};
}

} // namespace

Pass reprojection_pass()
{
    return {.id             = "reprojection",
            .summary        = "Finds where each reflection was in the frame before",
            .cite           = {"J.-P. Grenier 2017, Reprojecting Reflections (Bitsquid development blog)"},
            .parameters     = parameters(),
            .decide         = decide,
            .prepare        = prepare,
            .beyond_shading = true};
}

} // namespace ssrlab
