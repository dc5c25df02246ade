// Where each reflection was in the frame before.
#include "frame/passes/pass_helpers.h"

#include <limits>

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    const PassDecision bounces = bounces_pass().decide(facts, statistics, values);
    if (takes_bounces_from_history(facts, values) && bounces.verdict == PassDecision::needed)
        return {PassDecision::needed, "bounces come from the frame before"};
    const PassDecision picture = picture_history_pass().decide(facts, statistics, values);
    if (picture.verdict == PassDecision::needed && statistics.gbuffer.reflecting_pixels > 0) return picture;
    return needed_for_history(facts, statistics, values);
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    const Reprojection&    strategy = context.frame.plan.reprojection;
    ShaderSource           source{.file = "passes/reprojection.comp", .include_folders = {strategy.folder}};
    std::vector<Parameter> bare = strategy.parameters;
    for (Parameter& parameter : bare) parameter.name.erase(0, strategy.id.size() + 1);
    source.include_texts = {{"reprojection/parameters", parameter_declarations(bare, CONSTANT_REPROJECTION)}};
    source.include_files = {{"reprojection/reproject.glsl", strategy.folder / "reproject.glsl"}};
    source.defines.emplace("LAYERS", std::to_string(layers_of_hits(context.frame)));
    if (draws_lobe_rays(context.frame.plan.values)) source.defines.emplace("LOBE_RAYS", "1");
    auto pass = std::make_shared<ComputePass>(make_composed_pass(gpu, context, source, {}, strategy.parameters));
    constexpr float nan     = std::numeric_limits<float>::quiet_NaN();
    const auto      nowhere = glm::floatBitsToUint(glm::vec4(nan, nan, 0, -1));
    return [pass, &rays = ray_launch(context),
            no_rays = make_fill(gpu, context.frame.history->reprojected, nowhere)](const auto& commands) {
        no_rays(commands);
        dispatch_indirect(commands, *pass, rays);
    };
}

} // namespace

Pass reprojection_pass()
{
    return {.id             = "reprojection",
            .summary        = "Finds where each reflection was in the frame before",
            .cite           = {"J.-P. Grenier 2017, Reprojecting Reflections (Bitsquid development blog)"},
            .reads          = {Resource::gbuffer, Resource::objects, Resource::layers, Resource::rays, Resource::hits,
                               Resource::history},
            .writes         = {Resource::reprojected},
            .decide         = decide,
            .prepare        = prepare,
            .beyond_shading = true};
}

} // namespace ssrlab
