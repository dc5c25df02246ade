// What a row says about a run, from results whose figures are known.
#include "compare/validate_result.h"
#include "core/environment_variable.h"
#include "core/error.h"
#include "harness/columns.h"
#include "harness/measured_run.h"
#include "harness/passes.h"
#include "harness/progress.h"
#include "harness/quality.h"
#include "harness/samples.h"
#include "harness/sequence_state.h"
#include "harness/source_rows.h"
#include "temp_folder.h"
#include "truth_gbuffers.h"

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
    experiment.name           = "e";
    experiment.techniques     = {{id, "e.toml:1", {}, {}, {}}};
    experiment.known_settings = all_settings(load_catalogue());
    return experiment;
}

template <typename... Expected> void expect_numbers(const Record& row, const Expected&... expected)
{
    test::expect_each([&](const char* name) { return number_of(row, name); }, expected...);
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
    run.size_px   = {160, 90};
    run.at        = {3, 8};
    run.number    = 5;
    MeasuredRun measured;
    measured.run = &run;
    measured.row = identity_row(one_technique("walk"), run, walk);
    EXPECT_EQ(words_of(measured.row, "space"), "screen");
    expect_numbers(measured.row, "steps", 25, "width", 160, "height", 90, "frame", 3, "jitter_phases", 8, "run_number",
                   5, "thickness_m", 0.1, "max_distance_m", 1000000000);
    EXPECT_EQ(words_of(measured.row, "edge_fade"), "off");
    measured.pass_ms  = {{"trace", std::vector<double>(7, 4.0)}, {"composite", std::vector<double>(7, 1.5)}};
    measured.trace_ms = {1, 2, 3, 4, 5, 6, 7};
    measured.frame_ms = {11, 12, 13, 14, 15, 16, 17};
    add_times(measured, 7);
    add_measures(measured.row, no_measures());
    measured.row = failed_row(measured.row, Failure("no"));
    expect_numbers(measured.row, "trace_ms_median", 4, "trace_ms_ci_low", 1, "inverse_fps_s", 0.014);
    for (const auto& [name, value] : measured.row) EXPECT_THAT(names, testing::Contains(name));
}

// Every sum of passes has a figure of its own.
TEST(Rows, TimesWithKnownFigures)
{
    MeasuredRun measured;
    measured.trace_ms = {1, 2, 3, 4, 10, 12, 14, 16};
    measured.frame_ms = {40, 21, 22, 23, 24, 30, 32, 34};
    measured.pass_ms  = {{"classification", {1}}, {"rays", {2}},       {"depth_pyramid", {4}}, {"ray_packets", {8}},
                         {"hit_colour", {16}},    {"composite", {32}}, {"ray_reuse", {64}}};
    for (const char* pass : {"rays", "trace", "hit_colour", "ray_reuse", "composite"})
        measured.plan.passes.push_back({.id = pass, .runs = true, .reason = ""});
    measured.plan.passes.push_back({.id = "blur", .runs = false, .reason = ""});
    measured.structures        = {"depth_pyramid", "ray_packets", "not_built"};
    measured.frames_per_submit = 3;
    add_times(measured, 20);
    const std::map<std::string, double> expected = {{"trace_ms_median", 7},
                                                    {"trace_ms_mad", 5},
                                                    {"trace_ms_ci_low", 1},
                                                    {"trace_ms_ci_high", 16},
                                                    {"trace_drift", 4.2}, // 13 / 2.5 - 1
                                                    {"frame_ms_median", 27},
                                                    {"frame_ms_mad", 5},
                                                    {"frame_ms_ci_low", 21},
                                                    {"frame_ms_ci_high", 40},
                                                    {"repeats", 8},
                                                    {"frames_per_submit", 3},
                                                    {"gbuffer_ms_median", 20},
                                                    {"rays_ms_median", 3},
                                                    {"depth_pyramid.ms_median", 4},
                                                    {"ray_packets.ms_median", 8},
                                                    {"not_built.ms_median", 0},
                                                    {"structures_ms_median", 12},
                                                    {"shade_ms_median", 112},
                                                    {"passes_ran", 5},
                                                    {"fps", 1000.0 / 27},
                                                    {"inverse_fps_s", 0.027}};
    std::map<std::string, double>       found;
    for (const auto& [name, value] : measured.row) found[name] = *number_of(measured.row, name);
    EXPECT_EQ(found, expected);

    measured.row      = {};
    measured.trace_ms = {1, 2, 3, 4, 5};
    add_times(measured, 0);
    EXPECT_FALSE(measured.row.contains("trace_drift")) << "of five repeats";
    EXPECT_FALSE(measured.row.contains("gbuffer_ms_median")) << "of another renderer's frame";
}

TEST(Rows, EveryPassHasALineWithItsTimeAndReason)
{
    ssrlab::Run run;
    run.id = "ra";
    MeasuredRun measured;
    measured.run                    = &run;
    measured.plan.passes            = {{.id = "rays", .runs = true, .reason = "a, b"},
                                       {.id = "blur", .runs = false, .reason = "c"}};
    measured.pass_ms                = {{"rays", {1, 2, 3, 4, 5, 1.0 / 3, 9}}};
    measured.traffic                = {{"rays", {.pass = "rays", .read_bytes = 30, .written_bytes = 4}}};
    measured.plan.statistics.pixels = 8;
    const std::string text          = passes_text(measured);
    EXPECT_EQ(text, "ra,rays,true,3,0.333333,9,3.75,0.5,\"a, b\"\r\nra,blur,false,,,,,,c\r\n");
    EXPECT_THAT(count_passes(text + "rb,rays,true,1"), testing::ElementsAre(testing::Pair("ra", 1)));
    measured.pass_ms = {{"rays", {2, 2.5}}};
    EXPECT_THAT(passes_text(measured), testing::StartsWith("ra,rays,true,2.25,,,")) << "of two repeats";
}

TEST(Rows, EverySourceHasALineAndTheirSumIsInTheRow)
{
    ssrlab::Run run;
    run.id = "ra";
    MeasuredRun measured;
    measured.run      = &run;
    const auto source = [](int64_t place, const char* name, double ms, double f1) {
        return Record{{"place", place},     {"source", name},  {"draw_ms", ms},
                      {"trace_ms", 2 * ms}, {"shade_ms", 0.5}, {"merge_ms", 100.0},
                      {"megabytes", 1.25},  {"all_f1", f1},    {"handed", 7}};
    };
    measured.sources         = {source(0, "frame", 1, 0.5), source(1, "views:count=2", 10, 0.75)};
    const std::string   text = sources_text(measured);
    std::string_view    rest = text;
    std::vector<Record> rows;
    while (const auto fields = take_csv_record(rest)) rows.push_back(record_of(*fields, source_file_columns()));
    for (Record& record : measured.sources) record["run_id"] = "ra";
    EXPECT_EQ(rows, measured.sources);
    EXPECT_THAT(count_sources(text + "rb,0,frame"), testing::ElementsAre(testing::Pair("ra", 2)));
    add_sources(measured.row, measured.sources);
    // Merging on the CPU is part of no total, and the last source knows the answers of all.
    EXPECT_EQ(measured.row,
              (Record{{"sources_asked", 2}, {"sources_ms", 34.0}, {"sources_megabytes", 2.5}, {"all_f1", 0.75}}));
    measured.row = {};
    add_sources(measured.row, {});
    EXPECT_TRUE(measured.row.empty()) << "without [sources]";
}

TEST(Rows, WhatFailedIsToldFromWhatCannotBe)
{
    EXPECT_EQ(failed_row({}, Failure("no")), (Record{{"outcome", "failed"}, {"message", "no"}}));
    EXPECT_EQ(words_of(failed_row({}, InvalidResult("t")), "outcome"), "invalid");
}

TEST(Runs, IdsTellApartWhatDecidesAnOutcome)
{
    ssrlab::Run plain;
    plain.scene     = "a";
    plain.view      = "b";
    plain.size_px   = {16, 9};
    plain.technique = "walk";
    plain.values    = {{"steps", 25}, {"space", 1}};
    std::vector<ssrlab::Run> runs(12, plain);
    runs[1].scene              = "c";
    runs[2].view               = "c";
    runs[3].size_px            = {9, 16};
    runs[4].technique          = "run";
    runs[5].values.at("steps") = 26;
    runs[6].at                 = {1, 0};
    runs[7].at                 = {0, 8};
    runs[8].trace_text         = "thickness_m=2\n";
    runs[9].sources            = {"frame", parse_sources("frame", ""), HandOn::lost};
    runs[10].sources           = {"frame", parse_sources("frame", ""), HandOn::uncertain};
    runs[11].sources           = {"world", parse_sources("world", ""), HandOn::lost};
    std::set<std::string> ids;
    for (const ssrlab::Run& run : runs) ids.insert(run_id(run));
    EXPECT_EQ(ids.size(), runs.size());
    for (const size_t other : {1, 2, 3, 7}) EXPECT_FALSE(same_sequence(plain, runs[other])) << other;
    for (const size_t same : {4, 5, 6, 8, 9}) EXPECT_TRUE(same_sequence(plain, runs[same])) << same;
    EXPECT_FALSE(same_picture(plain, runs[6]));
    EXPECT_TRUE(same_picture(plain, runs[5]));
}

TEST(Runs, TooManyAreMadeOnlyWhenAskedFor)
{
    Experiment experiment = one_technique("walk");
    experiment.scenes     = {"a", "b"};
    experiment.views      = {"c", "d", "e"};
    experiment.sizes_px   = {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};
    experiment.frames     = {{0, 0}, {1, 0}};
    for (int steps = 1; steps <= 1000; ++steps) experiment.techniques[0].values["steps"].push_back(steps);
    experiment.settings["thickness_m"] = {1, 2};
    EXPECT_EQ(count_runs(experiment), 2 * 3 * 5 * 2 * 1000 * 2);
    experiment.techniques[0].settings["thickness_m"] = {3}; // its own in place of those
    EXPECT_EQ(count_runs(experiment), 2 * 3 * 5 * 2 * 1000);
    experiment.techniques[0].values["space"] = {0, 1};
    EXPECT_THROW(expand(experiment, {&walk, 1}), SpecError);
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
    EXPECT_EQ(lines_of(sample_columns(), text + "rb,9,frame,1,1\r\nrc,", {"ra"}), csv_line(sample_columns()) + text);
}

TEST(Rows, CountsOfAResultWithKnownFigures)
{
    using enum TraceStatus;
    TraceImage result{{5, 1},
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
    Record row;
    add_counts(row, result);
    EXPECT_EQ(words_of(row, "outcome"), "ok");
    expect_numbers(row, "rays", 4, "hit_share", 0.5, "out_of_steps_share", 0.25, "facing_away_share", 0, "steps_mean",
                   25, "depth_fetches_mean", 2.5, "structure_fetches_mean", 7.5, "depth_pyramid.fetches_mean", 7.5,
                   "fetches_mean", 10, "fetches_max", 10);
}

// Of 101 rays the sorted figure i is the quantile i / 100. As many pixels are not traced.
TEST(Rows, QuantilesAreOverTheRays)
{
    TraceImage result        = make_trace_image({202, 1}, true);
    result.structure_fetches = {{"depth_pyramid", std::vector<uint32_t>(202)}};
    for (size_t ray = 0; ray <= 100; ++ray) {
        const size_t i                         = 2 * ray + 1;
        result.status[i]                       = TraceStatus::left_screen;
        result.steps[i]                        = static_cast<uint32_t>(100 - ray);
        result.depth_fetches[i]                = ray == 100 ? 101 : 0;
        result.structure_fetches[0].fetches[i] = static_cast<uint32_t>(ray);
    }
    Record row;
    add_counts(row, result);
    expect_numbers(row, "rays", 101, "left_screen_share", 1, "steps_mean", 50, "steps_p99", 99, "steps_max", 100,
                   "depth_fetches_mean", 1, "structure_fetches_mean", 50, "depth_pyramid.fetches_mean", 50,
                   "fetches_mean", 51, "fetches_p50", 50, "fetches_p99", 99, "fetches_max", 201);
}

TEST(Rows, NothingToTraceIsAnOutcome)
{
    Record row;
    add_counts(row, {{1, 1}, {TraceStatus::not_traced}, {{}}, {0}, {{}}, {0}, {0}, {0}, {{"depth_pyramid", {0}}}});
    EXPECT_EQ(words_of(row, "outcome"), "no_rays");
    EXPECT_EQ(number_of(row, "rays"), 0);
    EXPECT_FALSE(row.contains("steps_mean"));
    EXPECT_FALSE(row.contains("hit_share"));
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
    EXPECT_EQ(number_of(measured.row, "saved_ms"), 4);
}

// Frames with outcomes ok, failed and ok; what is not ok has no part.
TEST(Rows, ASummaryIsOfTheFramesThatAreOk)
{
    const auto frame = [](const char* outcome, double ms, double rmse, double converged) {
        return Record{
            {"outcome", outcome}, {"trace_ms_median", ms}, {"picture_rmse", rmse}, {"converged_rmse", converged}};
    };
    const Record  frames[] = {frame("ok", 1, 0.1, 0.5), frame("failed", 90, 0.9, 0.9), frame("ok", 2, 0.3, 0.25),
                              frame("ok", 9, 0.8, 0.125)};
    SequenceState state;
    state.flips      = {3, 12};
    state.moments    = {{1, 3}, {1, 5}, {2, 2}}; // 0 and 1, whose mean is 0.5; 1 and 2
    state.pictures   = 2;
    const Record row = summary_row({{"run_id", "r"}, {"run_number", 1}, {"frame", 0}, {"scene", "s"}}, frames, state);
    EXPECT_EQ(words_of(row, "scene"), "s");
    EXPECT_FALSE(row.contains("run_id") || row.contains("run_number") || row.contains("frame"));
    // trace_ms_median: the median; the mean is 4
    expect_numbers(row, "frames", 3, "trace_ms_median", 2);
    EXPECT_DOUBLE_EQ(*number_of(row, "picture_rmse"), 0.4); // the mean; the median is 0.3
    EXPECT_FALSE(row.contains("history_share"));
    expect_numbers(row, "converged_rmse_last", 0.125, "flip_rate", 0.25, "temporal_rms", 0.5);

    state.moved = true;
    EXPECT_FALSE(summary_row({}, frames, state).contains("temporal_rms"));
    state.failed = true;
    EXPECT_FALSE(summary_row({}, frames, state).contains("flip_rate"));
}

TEST(Rows, FlipsAreOfPairsOfFramesBetweenWhichNothingMoved)
{
    TraceImage hit = make_trace_image({1, 1}, false), miss = hit;
    hit.status[0]  = TraceStatus::hit;
    miss.status[0] = TraceStatus::left_screen;
    const Image   picture{{1, 1}, {"R", "G", "B"}, {1, 1, 1}, {}};
    SequenceState state;
    EXPECT_TRUE(watch(state, picture, hit, {0, 0}, false).empty());
    EXPECT_EQ(watch(state, picture, miss, {0, 0}, false).at("flip_share"), 1);
    EXPECT_EQ(watch(state, picture, miss, {0, 0}, false).at("flip_share"), 0);
    EXPECT_TRUE(watch(state, picture, hit, {0, 0}, true).empty());
    EXPECT_TRUE(state.moved);
    EXPECT_EQ(state.flips.flips, 1U);
    EXPECT_EQ(state.flips.rays, 2U);
    EXPECT_EQ(state.pictures, 4);
}

TEST(Rows, ReflectedImageTakesTheHitPixelsRadiance)
{
    GBufferImage gbuffer;
    gbuffer.radiance    = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    TraceImage result   = make_trace_image({3, 1}, false);
    result.status       = {TraceStatus::hit, TraceStatus::left_screen, TraceStatus::not_traced};
    result.hit_pixel[0] = {2, 0};
    EXPECT_THAT(reflected_image(result, gbuffer, {7, 8, 9}).values, testing::ElementsAre(0, 0, 3, 7, 8, 9, 0, 0, 0));
}

TEST(Rows, ReflectedImageTakesTheRadianceOfTheLayerThatIsHit)
{
    GBufferImage gbuffer, behind, last;
    gbuffer.radiance    = {{1, 0, 0}, {2, 0, 0}};
    behind.radiance     = {{0, 3, 0}, {0, 4, 0}};
    last.radiance       = {{0, 0, 5}, {0, 0, 6}};
    gbuffer.layers      = {behind, last};
    TraceImage result   = make_trace_image({2, 1}, false);
    result.status       = {TraceStatus::hit, TraceStatus::hit};
    result.hit_pixel[0] = {1, 0};
    result.hit_layer    = {1, 2};
    EXPECT_THAT(reflected_image(result, gbuffer, {7, 8, 9}).values, testing::ElementsAre(0, 4, 0, 0, 0, 5));
}

// Pixel 0 reflects, pixel 1 is dull, pixel 2 empty. Of another renderer's frame it is not known what the mirror should show there.
TEST(Rows, AFrameWithoutTrianglesIsJudgedWhereItReflects)
{
    const TempFolder folder;
    GBufferImage     gbuffer = test::empty_gbuffer(test::bench_view({3, 1}));
    test::set_pixel(gbuffer, 0, 0, 2, {0, 0, 1}, 1);
    test::set_pixel(gbuffer, 1, 0, 2, {0, 0, 1}, 0);
    Scene scene;
    scene.frame.emplace();
    Truths truths(scene, gbuffer, folder.path());
    truths.make(boxes(), true);
    EXPECT_THAT(truths.without_scene(), testing::HasSubstr("has no triangles"));
    const Image     black{{3, 1}, {"R", "G", "B"}, std::vector<float>(9, 0.0F), {}};
    const Reference reference(black);
    Image           elsewhere = black, there = black;
    for (size_t i = 3; i < 9; ++i) elsewhere.values[i] = 1;
    for (size_t i = 0; i < 3; ++i) there.values[i] = 1;
    EXPECT_EQ(truths.compare_picture(elsewhere, reference).at("picture_rmse"), 0);
    EXPECT_EQ(truths.compare_picture(there, reference).at("picture_rmse"), 1);
    EXPECT_EQ(truths.compare_picture(there, reference).at("picture_visible_rmse"), std::nullopt);
    EXPECT_EQ(truths.compare_converged(there, reference).at("converged_rmse"), 1);
    TraceImage traced          = make_trace_image({3, 1}, false);
    traced.status[0]           = TraceStatus::left_screen;
    const MeasureValues values = truths.compare(traced, nullptr, nullptr);
    EXPECT_FALSE(values.contains("recall_1px"));
    EXPECT_FALSE(values.contains("wrong_rays"));
    EXPECT_FALSE(values.contains("rmse_visible"));
    EXPECT_EQ(values.at("screen_within_1px"), 1);
    EXPECT_TRUE(truths.agreement(traced));
    EXPECT_FALSE(truths.causes(traced));
}

TEST(Rows, TheTruthCacheLiesBesideTheResults)
{
    const EnvironmentVariable none("SSRLAB_CACHE", std::nullopt);
    EXPECT_EQ(truth_cache_dir("/a/results/steps"), "/a/results/.truth_cache");
    const EnvironmentVariable elsewhere("SSRLAB_CACHE", "/elsewhere");
    EXPECT_EQ(truth_cache_dir("/a/results/steps"), "/elsewhere");
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
