// Gloss by a blur of the reflection, at the image's resolution or at that of the rays.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide_if_blurred(const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<Gloss>(values) != Gloss::blur) return {PassDecision::off, "gloss is not blur"};
    if (statistics.gbuffer.reflecting_pixels > 0 && values.at("blur_bias") > 0)
        return {PassDecision::needed, "blur_bias is above 0"};
    return needed_if_anything_is_rough(statistics);
}

bool at_ray_resolution(const ParameterValues& values)
{
    return choice<BlurOrder>(values) == BlurOrder::before_upsampling && trace_block_px(values) > 1;
}

PassDecision decide_after(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (at_ray_resolution(values)) return {PassDecision::off, "blur_order = before_upsampling"};
    return decide_if_blurred(statistics, values);
}

PassDecision decide_before(const FrameFacts& /*facts*/, const FrameStatistics& statistics,
                           const ParameterValues& values)
{
    if (!at_ray_resolution(values))
        return {PassDecision::off, "not at a lower resolution with blur_order = before_upsampling"};
    return decide_if_blurred(statistics, values);
}

RecordFunction prepare_blur(Gpu& gpu, const PassContext& context, Defines defines)
{
    auto y = make_shared_pass(gpu, context, "passes/blur.comp", defines);
    defines.emplace("ALONG_X", "1");
    auto x = make_shared_pass(gpu, context, "passes/blur.comp", defines);
    return [x, y, no_reflection = make_reflection_fill(gpu, image_of(context, Resource::filtered)),
            &tiles = tile_launch(context)](const auto& commands) {
        no_reflection(commands); // of tiles that are not listed
        dispatch_indirect(commands, *x, tiles);
        barrier(commands);
        dispatch_indirect(commands, *y, tiles);
    };
}

RecordFunction prepare_after(Gpu& gpu, const PassContext& context) { return prepare_blur(gpu, context, {}); }
RecordFunction prepare_before(Gpu& gpu, const PassContext& context)
{
    return prepare_blur(gpu, context, {{"BLOCKS", "1"}});
}

} // namespace

Pass ray_blur_pass()
{
    return {.id             = "ray_blur",
            .summary        = "The blur at the resolution of the rays, before up-sampling",
            .cite           = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling"},
            .reads          = {Resource::gbuffer, Resource::tiles, Resource::reflection, Resource::block_pixel},
            .writes         = {Resource::filtered, Resource::reflection},
            .parameters     = {choice_parameter(
                    BlurOrder::after_upsampling,
                    "at half and quarter resolution: whether gloss = blur blurs the up-sampled reflection, or "
                        "the traced pixels alone, which are up-sampled afterwards")},
            .decide         = decide_before,
            .prepare        = prepare_before,
            .beyond_shading = true};
}

Pass blur_pass()
{
    return {
        .id             = "blur",
        .summary        = "Blurs the reflection by a separable Gaussian whose radius follows the roughness",
        .cite           = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling"},
        .reads          = {Resource::gbuffer, Resource::tiles, Resource::reflection},
        .writes         = {Resource::filtered, Resource::reflection},
        .parameters     = {choice_parameter(
                               Gloss::stochastic,
                               "how reflections widen on rough surfaces. off: not at all; blur: the reflection is blurred; "
                                   "cone: colours are looked up along a cone; stochastic: rays are drawn from the surface's "
                                   "lobe, and neighbours use each other's"),
                           real_parameter("blur_scale", 0.1, 0, 1,
                                          "blur radius at roughness 1, as a share of the image's height"),
                           real_parameter("blur_bias", 0, -1, 1,
                                          "added to the blur radius, as a share of the image's height"),
                           real_parameter("hole_blur_scale", 2, 1, 16, "factor on the blur radius of pixels without a hit"),
                           real_parameter("blur_hole_weight", 0.3, 0, 1, "weight of neighbours without a hit")},
        .decide         = decide_after,
        .prepare        = prepare_after,
        .beyond_shading = true};
}

} // namespace ssrlab
