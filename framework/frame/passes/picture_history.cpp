// The picture accumulated over the frames.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& facts, const FrameStatistics& /*statistics*/, const ParameterValues& values)
{
    if (values.at("picture_history_weight") == 0) return {PassDecision::off, "picture_history_weight = 0"};
    return needed_after_a_frame(facts);
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    Defines    defines; // with jitter alone there are no motion vectors
    const bool moved = context.frame.lab->gbuffer->motion_px.has_value();
    if (moved) defines.emplace("MOVED", "1");
    if (moved && runs(context.frame.plan, "reprojection") && trace_block_px(context.frame.plan.values) == 1)
        defines.emplace("REPROJECTED", "1");
    return [pass      = make_shared_pass(gpu, context, "passes/picture_history.comp", defines),
            &filtered = image_of(context, Resource::filtered),
            &shaded   = image_of(context, Resource::shaded)](const auto& commands) {
        dispatch(commands, *pass, groups_of_8(shaded.size_px));
        record_copy(commands, filtered, shaded);
    };
}

} // namespace

Pass picture_history_pass()
{
    return {.id      = "picture_history",
            .summary = "Accumulates the picture over the frames of a sequence",
            .cite    = {"B. Karis 2014, High-Quality Temporal Supersampling"},
            .reads = {Resource::gbuffer, Resource::objects, Resource::reprojected, Resource::history, Resource::shaded},
            .writes         = {Resource::filtered, Resource::shaded, Resource::kept},
            .parameters     = {real_parameter(
                    "picture_history_weight", 0, 0, 0.999,
                    "weight of the frames before in the accumulated picture, once there are enough for it: temporal "
                        "anti-aliasing of a jittered sequence, with the clamping and reject_depth of the reflection's history; "
                        "0: none. `ssrlab render --frames N --jitter M` takes 0.9 unless it is given")},
            .decide         = decide,
            .prepare        = prepare,
            .beyond_shading = true};
}

} // namespace ssrlab
