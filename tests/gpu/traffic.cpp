// The bytes that passes move.
#include "frame/stage.h"
#include "gpu/sequence_frames.h"

namespace ssrlab::test {
namespace {

PassTraffic of_pass(const std::vector<PassTraffic>& passes, const std::string& pass)
{
    const auto found = std::ranges::find(passes, pass, &PassTraffic::pass);
    if (found == passes.end()) throw std::logic_error(pass + " did not run");
    return *found;
}

// By the formats of framework/trace/gbuffer.h and frame/frame_inputs.h: radiance, highlight, emission, reflection and material have 8 bytes a
// pixel, the normal 16, depth and dielectric 4; a ray has 32, a hit 8.
TEST(Traffic, OfATinyFrameIsThatCountedByHand)
{
    const Picture   picture = make_picture("builtin:corridor", "default", {16, 16});
    ParameterValues passes  = default_pass_values();
    const auto [gloss, off] = chosen(Gloss::off);
    passes.at(gloss)        = off;
    const auto frame        = prepared_frame(picture.buffers, technique("linear"), values_of(technique("linear")),
                                             {boxes({.thickness_m = 0.1, .max_distance_m = 20}), "plane", passes});
    run_frame(device(), *frame);
    const auto     moved  = count_traffic(device(), *frame);
    const uint64_t pixels = 256, rays = plan_of(*frame).statistics.trace.rays;
    EXPECT_GT(rays, 16U);
    EXPECT_LT(rays, pixels);

    const PassTraffic composite = of_pass(moved, "composite"), trace = of_pass(moved, "trace"),
                      colour = of_pass(moved, "hit_colour");
    EXPECT_EQ(composite.read_bytes,
              pixels * 3 * 8 + rays * (2 * 8 + 16 + 4 + 4)); // rays: one for each pixel that reflects
    EXPECT_EQ(composite.written_bytes, pixels * 8);
    EXPECT_EQ(trace.read_bytes, 16 + rays * (32 + 16 + 8)); // how many rays there are; two depths are one texel
    EXPECT_EQ(trace.written_bytes, rays * 8);
    EXPECT_EQ(colour.written_bytes, pixels * 8); // filled before
    const PassTraffic sum = sum_of(moved);
    EXPECT_GT(sum.read_bytes, composite.read_bytes + trace.read_bytes);
    EXPECT_DOUBLE_EQ(least_ms({"", 3000, 1000}, 2), 0.002);
}

TEST(Traffic, OfTheDepthPyramidIsEachDepthOnceAndEachCellOnce)
{
    const Picture picture = make_picture("builtin:corridor", "default", {16, 16});
    const auto    frame =
        prepared_frame(picture.buffers, technique("hiz"), values_of(technique("hiz")), {boxes({.thickness_m = 0.1})});
    run_frame(device(), *frame);
    const PassTraffic pyramid = of_pass(count_traffic(device(), *frame), "depth_pyramid");
    EXPECT_EQ(pyramid.read_bytes, 16 * 16 * 4);
    EXPECT_EQ(pyramid.written_bytes, (8 * 8 + 4 * 4 + 2 * 2 + 1) * 8);
}

// Over two frames of a sequence with every pass that is not off.
TEST(Traffic, EveryPassMovesBytes)
{
    const glm::ivec2                                   size_px{64, 36};
    const std::vector<std::pair<int, ParameterValues>> choices = {
        {1,
         {chosen(Gloss::stochastic),
          chosen(MissLight::triangles),
          {"hidden_layer", 1},
          {"picture_history_weight", 0.5}}},
        {2, {chosen(Gloss::blur), chosen(Filter3x3::median3)}},
        {1, {chosen(Gloss::cone)}},
        {1, {chosen(Gloss::blur), chosen(TraceResolution::half), chosen(BlurOrder::before_upsampling)}}};
    std::set<std::string> moving;
    for (const auto& [layers, changed] : choices) {
        Stage         stage = open_stage(device(), catalogue(), load_scene("builtin:moving_boxes"));
        FrameSettings settings;
        settings.trace.surface = "plane_solid";
        settings.trace.layers  = layers;
        for (const auto& [name, value] : changed) settings.passes.at(name) = value;
        settings.passes.at("skip_unneeded_passes") = 0;
        const FrameHistoryPtr history              = make_history(device(), size_px);
        for (int number = 0; number < 2; ++number) {
            show(stage, "default", size_px, {number});
            const Technique&      hiz     = technique("hiz");
            const LabPtr          lab     = make_lab(stage, hiz, values_of(hiz), settings.trace);
            const FrameBuffersPtr buffers = make_frame_buffers(stage);
            const FramePlan       plan    = plan_frame(stage, lab, buffers, settings, history);
            const FramePtr        frame   = make_frame(device(), lab, buffers, plan, history);
            run_frame(device(), *frame);
            keep_history(device(), *frame, number);
            // Passes of a lower resolution run without need in the others, and move nothing there.
            for (const PassTraffic& pass : count_traffic(device(), *frame))
                if (pass.written_bytes > 0) moving.insert(pass.pass);
        }
    }
    for (const Pass& pass : all_passes())
        EXPECT_TRUE(moving.contains(pass.per_structure ? "depth_pyramid" : pass.id)) << pass.id;
}

} // namespace
} // namespace ssrlab::test
