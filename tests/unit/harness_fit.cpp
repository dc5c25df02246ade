// The choice within a budget, over rows whose best is known by argument.
#include "core/error.h"
#include "errors.h"
#include "harness/chip_cost.h"
#include "harness/fit.h"
#include "harness/write_experiment.h"
#include "temp_folder.h"
#include "test.h"

namespace ssrlab {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr FitGoal f1_by_fetches = {false, FitUnit::fetches}, flip_by_fetches = {true, FitUnit::fetches};
constexpr size_t  both[] = {0, 1}, first[] = {0};

Tried tried(const std::string& technique, std::vector<double> quality, std::vector<double> cost)
{
    Tried one;
    one.run.technique = technique;
    one.quality       = std::move(quality);
    one.cost          = std::move(cost);
    return one;
}

TEST(Fit, TakesTheBestMeanWhoseDearestPictureIsWithinTheBudget)
{
    const Tried all[] = {tried("cheap", {0.5, 0.5}, {1, 1}), tried("fine", {0.7, 0.7}, {4, 8}),
                         tried("dear", {0.9, 0.9}, {2, 8.5}), tried("second", {0.2, 1.0}, {8, 1})};
    EXPECT_EQ(fit_within(all, both, 8, f1_by_fetches).best, &all[1]);
    EXPECT_EQ(fit_within(all, both, 8, f1_by_fetches).runner_up, &all[3]);
    EXPECT_EQ(fit_within(all, first, 8, f1_by_fetches).best, &all[2]);
    EXPECT_EQ(fit_within(all, both, 4, f1_by_fetches).best, &all[0]);
    EXPECT_EQ(fit_within(all, both, 4, f1_by_fetches).runner_up, nullptr);
    EXPECT_EQ(fit_within(all, both, 16, f1_by_fetches).best, &all[2]);
}

TEST(Fit, OfEqualsTheCheapestThenTheFirst)
{
    const Tried all[] = {tried("a", {0.9}, {6}), tried("b", {0.9}, {5}), tried("c", {0.9}, {5}),
                         tried("b", {0.8}, {1})};
    const Fit   fit   = fit_within(all, first, 8, f1_by_fetches);
    EXPECT_EQ(fit.best, &all[1]);
    EXPECT_EQ(fit.runner_up, &all[2]); // of another technique
}

TEST(Fit, ASmallerFlipIsBetter)
{
    const Tried all[] = {tried("a", {0.2}, {1}), tried("b", {0.1}, {2}), tried("c", {0.3}, {2})};
    EXPECT_EQ(fit_within(all, first, 2, flip_by_fetches).best, &all[1]);
    EXPECT_EQ(fit_within(all, first, 2, flip_by_fetches).runner_up, &all[0]);
}

TEST(Fit, NothingWithinTheBudgetNamesTheCheapest)
{
    const Tried all[] = {tried("dear", {0.9, 0.9}, {3, 9}), tried("cheap", {0.5, 0.5}, {4, 5})};
    EXPECT_EQ(fit_within(all, both, 4.5, f1_by_fetches).best, nullptr);
    EXPECT_THAT(message_of<SpecError>([&] { require_fit(all, both, 4.5, f1_by_fetches); }),
                HasSubstr("within 4.5 fetches a ray on every picture; the cheapest, of cheap, takes 5"));
    EXPECT_THAT(message_of<SpecError>([&] {
                    require_fit(all, both, 1, {false, FitUnit::ms});
                }),
                HasSubstr("within 1 ms"));
    EXPECT_THAT(message_of<Failure>([&] { require_fit({}, both, 1, f1_by_fetches); }), HasSubstr("no setting"));
}

ssrlab::Run run_on(const std::string& scene, const std::string& technique, double max_steps = 8)
{
    ssrlab::Run run;
    run.scene     = scene;
    run.view      = "default";
    run.size_px   = {8, 8};
    run.technique = technique;
    run.values    = {{"max_steps", max_steps}};
    run.id        = run_id(run);
    return run;
}

Record row(double f1, double fetches, double rays)
{
    return {{"f1_1px", f1}, {"screen_f1_1px", 1.0}, {"fetches_mean", fetches}, {"rays", rays}};
}

TEST(Fit, FetchesArePaidPerRayOfTheSettingWithTheMostRays)
{
    const ssrlab::Run             settings[] = {run_on("a", "full"), run_on("a", "half")};
    std::map<std::string, Record> rows = {{settings[0].id, row(0.9, 20, 100)}, {settings[1].id, row(0.8, 24, 25)}};
    const auto                    all  = tried_on(std::span(settings, 1), settings, rows, f1_by_fetches);
    ASSERT_THAT(all, SizeIs(2));
    EXPECT_THAT(all[0].cost, ElementsAre(20));
    EXPECT_THAT(all[1].cost, ElementsAre(6));
    EXPECT_THAT(all[1].quality, ElementsAre(0.8));
}

TEST(Fit, InstructionsGrowWithTheIterationsOfAWave)
{
    const Record row = {{"rays", 50.0},
                        {"warp32_iterations_mean", 3.0},
                        {"wave64_iterations_mean", 5.0},
                        {"wave128_iterations_mean", 0.5}};
    // 3 of each of 100 pixels, 40 of each of 50 rays, and the loop's 10 again for each iteration but the first.
    EXPECT_EQ(instructions_of({3, 40, 10, 32}, row, {10, 10}), 6 + 40 + 20);
    EXPECT_EQ(instructions_of({3, 40, 10, 64}, row, {10, 10}), 6 + 40 + 40);
    EXPECT_EQ(instructions_of({3, 40, 10, 128}, row, {10, 10}), 6 + 40);
    EXPECT_EQ(instructions_of({3, 40, 10, 64}, {{"rays", 0.0}, {"wave64_iterations_mean", 0.0}}, {10, 10}),
              std::nullopt);
    EXPECT_EQ(instructions_of({3, 40, 10, 64}, {{"rays", 50.0}}, {10, 10}), std::nullopt);
}

TEST(Fit, InstructionsArePaidPerRayOfTheSettingWithTheMostRays)
{
    const ssrlab::Run             settings[] = {run_on("a", "full"), run_on("a", "half"), run_on("a", "not compiled")};
    std::map<std::string, Record> rows       = {
              {settings[0].id, row(0.9, 1, 100)}, {settings[1].id, row(0.8, 1, 25)}, {settings[2].id, row(0.9, 1, 100)}};
    rows[settings[0].id]["instructions"] = 300.0;
    rows[settings[1].id]["instructions"] = 360.0;
    const FitGoal goal                   = {false, FitUnit::instructions};
    const auto    all                    = tried_on(std::span(settings, 1), settings, rows, goal);
    ASSERT_THAT(all, SizeIs(2));
    EXPECT_THAT(all[0].cost, ElementsAre(300));
    EXPECT_THAT(all[1].cost, ElementsAre(90));
    EXPECT_THAT(message_of<SpecError>([&] { require_fit(all, first, 80, goal); }),
                HasSubstr("within 80 instructions a ray on every picture; the cheapest, of half, takes 90"));
}

TEST(Fit, MillisecondsAreThoseOfTheTraceOrOfTheWholeEffect)
{
    const ssrlab::Run setting = run_on("a", "t");
    const Record      one     = {{"f1_1px", 0.5},          {"picture_flip", 0.25},
                                 {"trace_ms_median", 1.0}, {"structures_ms_median", 2.0},
                                 {"rays_ms_median", 4.0},  {"shade_ms_median", 8.0}};
    const std::span   one_run(&setting, 1);
    const auto        rays = tried_on(one_run, one_run, {{setting.id, one}}, {false, FitUnit::ms});
    const auto        flip = tried_on(one_run, one_run, {{setting.id, one}}, {true, FitUnit::ms});
    EXPECT_THAT(rays.at(0).cost, ElementsAre(3));
    EXPECT_THAT(rays.at(0).quality, ElementsAre(0.5));
    EXPECT_THAT(flip.at(0).cost, ElementsAre(15));
    EXPECT_THAT(flip.at(0).quality, ElementsAre(0.25));
    // A frame of another renderer has no triangles.
    const ssrlab::Run frame = run_on("a.exr", "t");
    EXPECT_THAT(
        tried_on(std::span(&frame, 1), std::span(&frame, 1), {{frame.id, row(0.1, 2, 3)}}, f1_by_fetches).at(0).quality,
        ElementsAre(1.0));
}

TEST(Fit, ASettingThatFailedOnAPictureIsNoChoiceAndAPictureWithoutRaysIsLeftOut)
{
    const ssrlab::Run             settings[] = {run_on("a", "works"), run_on("a", "fails")};
    const ssrlab::Run             pictures[] = {run_on("a", "works"), run_on("b", "works"), run_on("empty", "works")};
    std::map<std::string, Record> rows;
    for (const ssrlab::Run& picture : pictures)
        for (const ssrlab::Run& setting : settings) {
            const ssrlab::Run run = on_picture(setting, picture);
            rows[run.id]          = picture.scene == "empty" ? Record{{"rays", 0.0}} : row(0.5, 10, 4);
        }
    rows[on_picture(settings[1], pictures[1]).id] = {{"outcome", "failed"}};
    const auto judged                             = judged_pictures(pictures, settings, rows, f1_by_fetches);
    ASSERT_THAT(judged, SizeIs(2));
    EXPECT_EQ(judged[1].scene, "b");
    const auto all = tried_on(judged, settings, rows, f1_by_fetches);
    ASSERT_THAT(all, SizeIs(1));
    EXPECT_EQ(all[0].run.technique, "works");
    EXPECT_THAT(all[0].cost, ElementsAre(10, 10));
    EXPECT_THAT(tried_on(pictures, settings, rows, f1_by_fetches), IsEmpty());
}

const Technique walk = {
    "walk", "Walk", "s",           {}, {},
    true,   {},     {"max_steps"}, 1,  {{"max_steps", ParameterType::integer, 64, 1, 60000, {}, "d"}},
    {}};

TEST(Fit, TriesStepsBetweenTheLastWithinAndTheFirstBeyondTheBudget)
{
    std::vector<Tried> all;
    for (const double steps : {8.0, 32.0, 128.0}) {
        all.push_back(tried("walk", {steps / 200}, {steps}));
        all.back().run = run_on("a", "walk", steps);
    }
    const auto next = next_tries({&walk, 1}, all, 20, f1_by_fetches);
    ASSERT_THAT(next, SizeIs(1));
    EXPECT_EQ(next[0].values.at("max_steps"), 16);
    EXPECT_EQ(next[0].id, run_on("a", "walk", 16).id);
    // What costs just the budget is within it.
    EXPECT_EQ(next_tries({&walk, 1}, all, 32, f1_by_fetches).at(0).values.at("max_steps"), 64);
    EXPECT_THAT(next_tries({&walk, 1}, all, 500, f1_by_fetches), IsEmpty());
    EXPECT_THAT(next_tries({&walk, 1}, all, 1, f1_by_fetches), IsEmpty());
    // Nothing beyond is better than what another technique has within.
    all.push_back(tried("other", {0.9}, {10}));
    EXPECT_THAT(next_tries({&walk, 1}, all, 20, f1_by_fetches), IsEmpty());
    EXPECT_THAT(next_tries({&walk, 1}, all, 20, flip_by_fetches), IsEmpty());
}

TEST(Fit, LeavesEachPictureOfASceneOutOnce)
{
    const ssrlab::Run pictures[] = {run_on("a", "x"), run_on("a", "x"), run_on("b", "x")};
    const Tried       all[]      = {tried("x", {0.9, 0.1, 0.5}, {1, 1, 1}), tried("y", {0.2, 0.8, 0.5}, {1, 1, 1})};
    const auto        left_out   = leave_one_out(all, pictures, 1, f1_by_fetches);
    ASSERT_THAT(left_out, SizeIs(2));
    EXPECT_EQ(left_out[0].picture, 0U);
    EXPECT_EQ(left_out[0].fitted, &all[1]);
    EXPECT_EQ(left_out[0].best, &all[0]);
    EXPECT_EQ(left_out[1].fitted, &all[0]);
    EXPECT_EQ(left_out[1].best, &all[1]);
    EXPECT_EQ(leave_one_out(all, pictures, 0.5, f1_by_fetches).at(0).fitted, nullptr);
}

TEST(WriteExperiment, ReadsBackAsTheSameRuns)
{
    const TempFolder               folder;
    const Catalogue                catalogue  = load_catalogue();
    const auto                     spec       = folder.write("s.toml", R"(
scenes = ["builtin:corridor", "builtin:stairs"]
views  = { "builtin:corridor" = ["default", "steep"] }
sizes  = ["64x36"]
frames = [0, 3]
[passes]
trace_resolution = ["full", "half"]
reprojection     = "smallest"
smallest.factor  = 1.25
[[techniques.hiz]]
surface             = "box"
thickness_m         = [0.05, 0.3]
thickness_relative  = true
depth_pyramid.kind  = "nearest"
[[techniques.linear]]
steps       = 60000
space       = "pixels"
interpolate = true
stride_px   = 2.5
max_distance_m = inf
)");
    const Experiment               experiment = load_experiment(spec, catalogue);
    const std::vector<ssrlab::Run> runs       = expand(experiment, catalogue.techniques);
    std::vector<ssrlab::Run>       settings, pictures;
    std::set<std::string>          ids, again;
    for (const ssrlab::Run& run : runs) {
        ids.insert(run.id);
        if (same_picture(run, runs.front())) settings.push_back(run);
        if (pictures.empty() || !same_picture(run, pictures.back())) pictures.push_back(run);
    }
    const auto text      = experiment_text("again", pictures, settings, experiment.known_settings, catalogue.techniques,
                                           "min_repeats = 3\n");
    const auto read_back = load_experiment(folder.write("again.toml", text), catalogue);
    EXPECT_EQ(read_back.name, "again");
    EXPECT_EQ(read_back.measure.min_repeats, 3);
    for (const ssrlab::Run& run : expand(read_back, catalogue.techniques)) again.insert(run.id);
    EXPECT_EQ(ids.size(), 6U * 6U);
    EXPECT_EQ(again, ids) << text;
}

} // namespace
} // namespace ssrlab
