// A timed frame: its times are there, its hits are the counting pipeline's, and running again changes nothing.
#include "compare/measures.h"
#include "core/pixel_index.h"
#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "trace/lab.h"

namespace ssrlab::test {
namespace {

class FrameRuns : public testing::TestWithParam<const char*> {};

TEST_P(FrameRuns, TimesAreThereAndResultsAreTheCountedOnes)
{
    const Picture       picture  = make_picture("builtin:pole_field", "down", {161, 91});
    const TraceSettings settings = boxes({.thickness_m = 0.1, .max_distance_m = 20});
    const Technique&    t        = technique(GetParam());
    const auto          frame    = prepared_frame(picture.buffers, t, values_of(t), {settings});
    const TraceImage    first = counted(*frame), second = counted(*frame);
    std::string         text;
    EXPECT_EQ(count_differences(first, second, bit_equal_t, text), 0U) << text;
    EXPECT_EQ(first.steps, second.steps);
    EXPECT_EQ(first.depth_fetches, second.depth_fetches);
    EXPECT_EQ(first.structure_fetches, second.structure_fetches);
    EXPECT_EQ(first.traced_order, second.traced_order);

    std::vector<float> shaded;
    for (int run = 0; run < 3; ++run) {
        const FrameTimes times = run_frame(device(), *frame, run + 1); // frames in one submit
        for (const double ms : {times.of("rays"), times.of("trace"), times.of("composite")}) {
            EXPECT_GT(ms, 0);
            EXPECT_LT(ms, 60000);
        }
        for (const Structure& structure : t.structures) EXPECT_GE(times.of(structure.id), 1e-4) << structure.id;
        const TraceImage timed = read_result<float>(device(), *frame->inputs.lab, *frame->inputs.rays, nullptr);
        EXPECT_EQ(count_differences(timed, first, bit_equal_t, text), 0U) << "run " << run << ": " << text;
        const auto pixels = read_shaded(device(), *frame).values;
        if (run == 0) shaded = pixels;
        EXPECT_EQ(pixels, shaded) << "run " << run;
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, FrameRuns, testing::Values("dda", "hiz", "linear", "linear_binary"),
                         [](const auto& param) { return std::string(param.param); });

TEST(FrameRuns, TheOrderOfTheRaysIsThatOfTheList)
{
    const Picture       picture  = make_picture("builtin:pole_field", "down", {161, 91});
    const TraceSettings settings = boxes({.thickness_m = 0.1, .max_distance_m = 20});
    const Technique&    hiz      = technique("hiz");
    const TraceImage    result   = trace(picture, hiz, values_of(hiz), settings);
    const TracerPtr     tracer   = make_tracer(device(), lab_on_picture(picture, hiz, values_of(hiz), settings));
    std::vector<size_t> listed;
    for (const RayInput& ray : set_up_rays(device(), *tracer)) listed.push_back(pixel_index(ray.pixel, {161, 91}));
    EXPECT_GT(listed.size(), 1000U);
    EXPECT_EQ(result.traced_order, listed);
    EXPECT_FALSE(std::ranges::is_sorted(listed)); // tiles, not rows
    const auto values = count_work(result);
    EXPECT_GT(values.at("wave64_iterations_mean"), values.at("warp32_iterations_mean"));
    EXPECT_GT(values.at("warp32_iterations_mean"), values.at("steps_mean"));
}

TEST(GBufferRuns, TheSamePictureEveryTime)
{
    const Picture picture = make_picture("builtin:corridor", "default", {161, 91});
    EXPECT_GT(redraw_gbuffer(device(), *picture.drawing), 0);
    const GBufferImage again = read_gbuffer(device(), *picture.gbuffer);
    EXPECT_EQ(again.depth, picture.image.depth);
    EXPECT_EQ(again.normal_vs, picture.image.normal_vs);
    EXPECT_EQ(again.radiance, picture.image.radiance);
    EXPECT_EQ(again.object_id, picture.image.object_id);
}

// Two techniques share one set of buffers: what one leaves behind must not reach the other.
TEST(SharedBuffers, KeepNoTraceOfTheRunBefore)
{
    const Picture                             picture  = make_picture("builtin:pole_field", "default", {161, 91});
    const TraceSettings                       settings = boxes({.thickness_m = 0.1});
    std::map<std::string, FramePtr>           frames;
    std::map<std::string, std::vector<float>> shaded;
    for (const char* id : {"dda", "hiz", "linear"})
        frames[id] = prepared_frame(picture.buffers, technique(id), values_of(technique(id)), {settings});
    for (int round = 0; round < 2; ++round)
        for (auto& [id, frame] : frames) {
            run_frame(device(), *frame);
            const auto pixels = read_shaded(device(), *frame).values;
            if (round == 0) shaded[id] = pixels;
            EXPECT_EQ(pixels, shaded[id]) << id;
        }
    EXPECT_EQ(shaded["dda"], shaded["hiz"]);
}

} // namespace
} // namespace ssrlab::test
