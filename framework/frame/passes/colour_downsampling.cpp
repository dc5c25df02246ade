// The lit colour at the resolution of the rays.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("downsample_cross_blur") == 0) return {PassDecision::off, "downsample_cross_blur = false"};
    return needed_at_lower_resolution(facts, statistics, values);
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    const glm::ivec2 blocks =
        (context.frame.lab->gbuffer->view.size_px - 1) / trace_block_px(context.frame.plan.values) + 1;
    return [blocks, pass = make_shared_pass(gpu, context, "passes/colour_downsampling.comp")](const auto& commands) {
        dispatch(commands, *pass, groups_of_8(blocks));
    };
}

} // namespace

Pass colour_downsampling_pass()
{
    return {.id         = "colour_downsampling",
            .summary    = "Downsamples the lit colour to the resolution of the rays, with a cross-shaped blur",
            .cite       = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling"},
            .reads      = {Resource::light},
            .writes     = {Resource::small_colour},
            .parameters = {boolean_parameter("downsample_cross_blur", true,
                                             "at half and quarter resolution, rays read colours that are downsampled "
                                             "to that resolution with a cross-shaped blur")},
            .decide     = decide,
            .prepare    = prepare};
}

} // namespace ssrlab
