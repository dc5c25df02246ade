// What a row says about a run, from results whose figures are known.
#include "core/error.h"
#include "harness/columns.h"
#include "harness/measured_run.h"
#include "harness/progress.h"
#include "harness/quality.h"
#include "harness/samples.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <set>

namespace ssrlab {
namespace {

const Technique walk = {"walk",
                        "Walk",
                        "s",
                        {},
                        {},
                        false,
                        {},
                        {"steps"},
                        1,
                        {{"steps", ParameterType::integer, 64, 1, 60000, {}, "d"},
                         {"space", ParameterType::choice, 0, 0, 1, {"view", "screen"}, "d"}},
                        {}};

Experiment one_technique(const std::string& id)
{
    Experiment experiment;
    experiment.name       = "e";
    experiment.techniques = {{id, "e.toml:1", {}, {}}};
    return experiment;
}

TEST(Rows, ColumnsAreUniqueAndIdentityComesFirst)
{
    const Technique techniques[] = {walk};
    const auto      names        = names_of(result_columns(one_technique("walk"), techniques));
    EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
    EXPECT_EQ(names.front(), "run_id");
    EXPECT_EQ(names.back(), "message");
    for (const char* name :
         {"steps", "space", "trace_ms_median", "frame_ms_median", "fps", "inverse_fps_s", "rays",
          "structures_ms_median", "depth_fetches_mean", "fetches_p99", "recall_1px", "out_of_steps_share", "outcome"}) {
        EXPECT_THAT(names, testing::Contains(name));
    }
}

TEST(Rows, AParameterMayNotBeNamedLikeAColumn)
{
    for (const char* name : {"rays", "thickness_m", "recall_1px", "outcome"}) {
        Technique clash          = walk;
        clash.folder             = "techniques/walk";
        clash.parameters[0].name = name;
        try {
            result_columns(one_technique("walk"), {&clash, 1});
            FAIL() << name;
        } catch (const SpecError& error) {
            EXPECT_THAT(error.what(),
                        testing::HasSubstr("techniques/walk/technique.toml: parameter '" + std::string(name) + "'"));
        }
    }
}

TEST(Rows, EveryEntryOfARowHasAColumn)
{
    const Technique techniques[] = {walk};
    const auto      names        = names_of(result_columns(one_technique("walk"), techniques));
    ssrlab::Run     run;
    run.scene     = "a";
    run.technique = "walk";
    run.values    = {{"steps", 25}, {"space", 1}};
    MeasuredRun measured;
    measured.run = &run;
    measured.row = identity_row(one_technique("walk"), run, walk);
    EXPECT_EQ(measured.row.at("space"), "screen");
    EXPECT_EQ(measured.row.at("steps"), "25");
    EXPECT_EQ(measured.row.at("thickness_m"), "0.1");
    EXPECT_EQ(measured.row.at("max_distance_m"), "1000000000");
    EXPECT_EQ(measured.row.at("edge_fade"), "off");
    measured.pass_order = {"trace", "composite"};
    measured.pass_ms    = {{"trace", std::vector<double>(7, 4.0)}, {"composite", std::vector<double>(7, 1.5)}};
    measured.trace_ms   = {1, 2, 3, 4, 5, 6, 7};
    measured.frame_ms   = {11, 12, 13, 14, 15, 16, 17};
    add_plan(measured.row, plan_frame({}, {}, default_pass_values()));
    add_times(measured, 7);
    add_measures(measured.row, no_measures());
    measured.row = failed_row(measured.row, Failure("no"));
    EXPECT_EQ(measured.row.at("trace_ms_median"), "4");
    EXPECT_EQ(measured.row.at("trace_ms_ci_low"), "1");
    EXPECT_EQ(measured.row.at("inverse_fps_s"), "0.014");
    EXPECT_EQ(measured.row.at("passes"), "trace=4 composite=1.5");
    EXPECT_THAT(measured.row.at("passes_skipped"), testing::HasSubstr("trace"));
    EXPECT_THAT(measured.row.at("passes_why"), testing::ContainsRegex("trace: [^;]+; "));
    for (const auto& [name, value] : measured.row) EXPECT_THAT(names, testing::Contains(name));
}

TEST(Rows, SamplesReadBackAsTheyWere)
{
    ssrlab::Run run;
    run.id = "ra";
    MeasuredRun measured;
    measured.run           = &run;
    measured.rounds        = {3, 4};
    measured.pass_ms       = {{"trace", {0.1, 1.0 / 3}}};
    measured.frame_ms      = {2, 4};
    measured.cpu_ms        = {7, 8};
    const std::string text = samples_text(measured);
    EXPECT_EQ(text, "ra,3,trace,0.1,\r\nra,3,frame,2,7\r\nra,4,trace,0.3333333333333333,\r\nra,4,frame,4,8\r\n");
    const SampleCounts counts = count_samples(text + "rb,9,frame,1");
    EXPECT_THAT(counts.frames, testing::ElementsAre(testing::Pair("ra", 2)));
    EXPECT_EQ(counts.next_round, 5);
    EXPECT_EQ(samples_of(text + "rb,9,frame,1,1\r\nrc,", {"ra"}), csv_line(sample_columns()) + text);
}

TEST(Rows, CountsOfAResultWithKnownFigures)
{
    using enum TraceStatus;
    TraceResult result{{5, 1},
                       {not_traced, hit, left_screen, out_of_steps, hit},
                       {},
                       {},
                       {},
                       {},
                       {0, 10, 20, 30, 40},
                       {0, 1, 2, 3, 4},
                       {{"depth_pyramid", {0, 9, 8, 7, 6}}}};
    result.hit_pixel.resize(5);
    result.hit_px_depth.resize(5);
    result.hit_t.resize(5);
    Row row;
    add_counts(row, result);
    EXPECT_EQ(row.at("outcome"), "ok");
    EXPECT_EQ(row.at("rays"), "4");
    EXPECT_EQ(row.at("hit_share"), "0.5");
    EXPECT_EQ(row.at("out_of_steps_share"), "0.25");
    EXPECT_EQ(row.at("facing_away_share"), "0");
    EXPECT_EQ(row.at("steps_mean"), "25");
    EXPECT_EQ(row.at("depth_fetches_mean"), "2.5");
    EXPECT_EQ(row.at("structure_fetches_mean"), "7.5");
    EXPECT_EQ(row.at("depth_pyramid.fetches_mean"), "7.5");
    EXPECT_EQ(row.at("fetches_mean"), "10");
    EXPECT_EQ(row.at("fetches_max"), "10");
}

TEST(Rows, NothingToTraceIsAnOutcome)
{
    Row row;
    add_counts(row, {{1, 1}, {TraceStatus::not_traced}, {{}}, {0}, {{}}, {0}, {0}, {0}, {{"depth_pyramid", {0}}}});
    EXPECT_EQ(row.at("outcome"), "no_rays");
    EXPECT_EQ(row.at("rays"), "0");
    EXPECT_FALSE(row.contains("steps_mean"));
    EXPECT_FALSE(row.contains("hit_share"));
    EXPECT_EQ(number_text(std::nan("")), "");
}

TEST(Rows, RepeatsFillTheBudgetWithinTheirBounds)
{
    MeasureSettings measure;
    measure.min_repeats = 6;
    measure.max_repeats = 30;
    measure.budget_s    = 1;
    EXPECT_EQ(repeats_for(0.1, measure), 10);
    EXPECT_EQ(repeats_for(99, measure), 6);
    EXPECT_EQ(repeats_for(1e-6, measure), 30);
    EXPECT_EQ(repeats_for(0, measure), 30);
}

TEST(Rows, AFastGpuHasSeveralFramesInASubmit)
{
    GpuInfo gpu, cpu;
    gpu.type = "DiscreteGpu";
    cpu.type = "Cpu";
    MeasureSettings measure;
    EXPECT_EQ(frames_for(2, measure, gpu), 3);
    EXPECT_EQ(frames_for(6, measure, gpu), 1);
    EXPECT_EQ(frames_for(0, measure, gpu), 64);
    EXPECT_EQ(frames_for(0.001, measure, cpu), 1);
    measure.frames_per_submit = 4;
    EXPECT_EQ(frames_for(6, measure, gpu), 4);
    EXPECT_EQ(frames_for(6, measure, cpu), 4);
}

TEST(Rows, SavedTimeIsTheMedianOfItsPairsAndEmptyWithoutAny)
{
    MeasuredRun measured;
    measured.trace_ms = measured.frame_ms = {1, 2, 3};
    add_times(measured, 0);
    EXPECT_FALSE(measured.row.contains("saved_ms"));
    measured.saved_ms = {4, 9, -1};
    add_times(measured, 0);
    EXPECT_EQ(measured.row.at("saved_ms"), "4");
}

TEST(Rows, ReflectedImageTakesTheHitPixelsRadiance)
{
    GBufferImage gbuffer;
    gbuffer.radiance    = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    TraceResult result  = make_trace_result({3, 1}, false);
    result.status       = {TraceStatus::hit, TraceStatus::left_screen, TraceStatus::not_traced};
    result.hit_pixel[0] = {2, 0};
    EXPECT_THAT(reflected_image(result, gbuffer, {7, 8, 9}).values, testing::ElementsAre(0, 0, 3, 7, 8, 9, 0, 0, 0));
}

TEST(Rows, TheTruthCacheLiesBesideTheResults)
{
    ::unsetenv("SSRLAB_CACHE");
    EXPECT_EQ(truth_cache_dir("/a/results/steps"), "/a/results/.truth_cache");
    ::setenv("SSRLAB_CACHE", "/elsewhere", 1);
    EXPECT_EQ(truth_cache_dir("/a/results/steps"), "/elsewhere");
    ::unsetenv("SSRLAB_CACHE");
}

// What two cores took for a frame of thin_yard (results/reference/lavapipe/resolution), within a factor of two.
TEST(Rows, TheEstimateFollowsSizeAndTechnique)
{
    MeasureSettings measure;
    measure.truth       = false;
    measure.min_repeats = measure.max_repeats = 1;
    Technique dda                             = walk, hiz;
    dda.exact                                 = true;
    dda.bounded_by                            = {"steps"};
    dda.parameters[0].max                     = 60000;
    hiz                                       = dda;
    hiz.structures.resize(1);
    const auto frame_s = [&](const Technique& technique, glm::ivec2 size_px) {
        ssrlab::Run run;
        run.size_px         = size_px;
        run.values          = {{"steps", 60000}, {"space", 1}};
        const double one    = estimated_seconds(run, technique, measure);
        measure.min_repeats = measure.max_repeats = 2;
        const double two                          = estimated_seconds(run, technique, measure);
        measure.min_repeats = measure.max_repeats = 1;
        return two - one;
    };
    const auto near = [](double seconds) { return testing::AllOf(testing::Gt(seconds / 2), testing::Lt(seconds * 2)); };
    EXPECT_THAT(frame_s(dda, {480, 270}), near(0.022));
    EXPECT_THAT(frame_s(dda, {3840, 2160}), near(15.6));
    EXPECT_THAT(frame_s(hiz, {480, 270}), near(0.0055));
    EXPECT_THAT(frame_s(hiz, {3840, 2160}), near(0.93));
}

TEST(Rows, Durations)
{
    EXPECT_EQ(duration_text(7), "0:07");
    EXPECT_EQ(duration_text(187.4), "3:07");
    EXPECT_EQ(duration_text(3729), "1:02:09");
}

} // namespace
} // namespace ssrlab
