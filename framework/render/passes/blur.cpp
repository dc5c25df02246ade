// Gloss by a blur of the reflection.
#include "render/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<Gloss>(values) != Gloss::blur) return {PassDecision::off, "gloss is not blur"};
    if (statistics.gbuffer.reflecting_pixels > 0 && values.at("blur_bias") > 0)
        return {PassDecision::needed, "blur_bias is above 0"};
    return needed_if_anything_is_rough(statistics);
}

RecordFunction prepare(Gpu& gpu, PreparedFrame& frame)
{
    return [&frame, x = make_shared_pass(gpu, frame, "passes/blur.comp", {{"ALONG_X", "1"}}),
            y = make_shared_pass(gpu, frame, "passes/blur.comp")](const auto& commands) {
        record_clear_reflection(commands, frame.buffers->filtered); // of tiles that are not listed
        dispatch_indirect(commands, *x, frame.buffers->tiles.launch);
        barrier(commands);
        dispatch_indirect(commands, *y, frame.buffers->tiles.launch);
    };
}

} // namespace

Pass blur_pass()
{
    return {
        .id      = "blur",
        .summary = "Blurs the reflection by a separable Gaussian whose radius follows the roughness",
        .cite    = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling"},
        .parameters =
            {choice_parameter(Gloss::blur, "how reflections widen on rough surfaces. off: not at all; blur: the "
                                           "reflection is blurred; cone: colours are looked up along a cone"),
             real_parameter("blur_scale", 0.1, 0, 1, "blur radius at roughness 1, as a share of the image's height"),
             real_parameter("blur_bias", 0, -1, 1, "added to the blur radius, as a share of the image's height"),
             real_parameter("hole_blur_scale", 2, 1, 16, "factor on the blur radius of pixels without a hit"),
             real_parameter("blur_hole_weight", 0.3, 0, 1, "weight of neighbours without a hit")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
