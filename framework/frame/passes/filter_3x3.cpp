// A 3 x 3 filter on the reflection, against noise.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<Filter3x3>(values) == Filter3x3::off) return {PassDecision::off, "filter_3x3 = off"};
    if (statistics.gbuffer.reflecting_pixels == 0) return needed_if_anything_reflects(facts, statistics, values);
    const TraceCounts& trace = statistics.trace;
    const bool second_layer  = hidden_layer_pass().decide(facts, statistics, values).verdict == PassDecision::needed;
    if (trace.hits == 0 && !second_layer) return {PassDecision::not_needed, "no ray hits anything"};
    return {PassDecision::needed, fmt::format("{} rays hit ({})", trace.hits, percent(trace.hits, trace.rays))};
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    return [pass = make_shared_pass(gpu, context, "passes/filter_3x3.comp"), &tiles = tile_launch(context),
            no_reflection = make_reflection_fill(gpu, image_of(context, Resource::filtered)),
            &filtered     = image_of(context, Resource::filtered),
            &reflection   = image_of(context, Resource::reflection)](const auto& commands) {
        no_reflection(commands); // of tiles that are not listed
        dispatch_indirect(commands, *pass, tiles);
        record_copy(commands, filtered, reflection);
    };
}

} // namespace

Pass filter_3x3_pass()
{
    return {.id             = "filter_3x3",
            .summary        = "Filters the reflection over 3 x 3 pixels, against noise",
            .cite           = {"J. Somerville Roberts, Screen Space Reflections"},
            .reads          = {Resource::tiles, Resource::reflection},
            .writes         = {Resource::filtered, Resource::reflection},
            .parameters     = {choice_parameter(
                    Filter3x3::off, "filter over 3 x 3 pixels: none, the mean, or the neighbour of median brightness")},
            .decide         = decide,
            .prepare        = prepare,
            .beyond_shading = true};
}

} // namespace ssrlab
