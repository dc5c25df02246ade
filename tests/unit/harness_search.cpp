// The search for a target: on curves that are known, it ends between the two values where the curve crosses.
#include "harness/search.h"
#include "test.h"

namespace ssrlab {
namespace {

const Technique march = {"march",
                         "March",
                         "s",
                         {},
                         {},
                         false,
                         {},
                         {},
                         1,
                         {{"steps", ParameterType::integer, 64, 1, 60000, {}, "d"},
                          {"stride_px", ParameterType::real, 1, 0.0625, 256, {}, "d"},
                          {"interval", ParameterType::boolean, 0, 0, 1, {}, "d"}},
                         {},
                         {{"steps", true}, {"stride_px", false}}};

ssrlab::Run run_with(double steps, double stride_px, double interval)
{
    ssrlab::Run run;
    run.scene     = "a";
    run.view      = "default";
    run.technique = "march";
    run.values    = {{"steps", steps}, {"stride_px", stride_px}, {"interval", interval}};
    run.id        = run_id(run);
    return run;
}

using Curve = std::function<double(const ssrlab::Run&)>;

/// Every run of the frame once the search is over.
std::vector<ssrlab::Run> searched(std::vector<ssrlab::Run> runs, std::vector<Target> targets, const Curve& curve,
                                  const std::string& measure = "recall_1px")
{
    Experiment experiment;
    experiment.targets = std::move(targets);
    std::map<std::string, Record> rows;
    for (size_t known = 0; known < runs.size();) {
        for (; known < runs.size(); ++known) rows[runs[known].id] = {{measure, curve(runs[known])}};
        const auto more = next_probes(experiment, {&march, 1}, runs, rows);
        runs.insert(runs.end(), more.begin(), more.end());
        EXPECT_LT(runs.size(), 200U);
    }
    return runs;
}

double saturating(const ssrlab::Run& run) { return 1 - 10 / (run.values.at("steps") + 10); }

TEST(Search, EndsBetweenNeighboursThatAreCloseEnough)
{
    // 0.99 at 990 steps, 0.9 at 90.
    const auto runs = searched({run_with(16, 1, 0), run_with(256, 1, 0), run_with(4096, 1, 0)},
                               {{"recall_1px", {0.9, 0.99}}}, saturating);
    for (const double crossing : {90.0, 990.0}) {
        double below = 0, above = 1e9;
        for (const ssrlab::Run& run : runs) {
            const double steps = run.values.at("steps");
            if (steps < crossing) below = std::max(below, steps);
            if (steps >= crossing) above = std::min(above, steps);
        }
        EXPECT_LE(above / below, search_ratio) << below << " " << above;
    }
    EXPECT_LE(runs.size(), 3U + 2 * 5); // bisection, not a finer sweep
    for (size_t i = 3; i < runs.size(); ++i) EXPECT_EQ(runs[i].number, static_cast<int>(i));
}

TEST(Search, TurnsAParameterThatIsBetterWhenLower)
{
    const auto runs = searched({run_with(9, 16, 0), run_with(9, 0.25, 0)}, {{"recall_1px", {0.5}}},
                               [](const ssrlab::Run& run) { return 1 / (1 + run.values.at("stride_px")); });
    double     miss = 1e9, reach = 0;
    for (const ssrlab::Run& run : runs) {
        const double stride_px = run.values.at("stride_px");
        if (stride_px <= 1) reach = std::max(reach, stride_px);
        if (stride_px > 1) miss = std::min(miss, stride_px);
    }
    EXPECT_LE(miss / reach, search_ratio);
}

TEST(Search, TurnsEachLineByItselfAndAnErrorDownward)
{
    // With the interval test the same error takes a quarter of the steps.
    const auto error = [](const ssrlab::Run& run) {
        return 100 / (run.values.at("steps") * (run.values.at("interval") != 0 ? 4 : 1));
    };
    const auto runs = searched({run_with(16, 1, 0), run_with(4096, 1, 0), run_with(16, 1, 1), run_with(4096, 1, 1)},
                               {{"flip_visible", {0.1}, false}}, error, "flip_visible");
    for (const double interval : {0.0, 1.0}) {
        double best = 1e9;
        for (const ssrlab::Run& run : runs)
            if (run.values.at("interval") == interval && error(run) <= 0.1)
                best = std::min(best, run.values.at("steps"));
        const double crossing = interval != 0 ? 250 : 1000;
        EXPECT_GE(best, crossing);
        EXPECT_LE(best, crossing * search_ratio);
    }
}

TEST(Search, StaysInsideTheListedRangeAndEndsOnFailures)
{
    const std::vector<ssrlab::Run> listed = {run_with(16, 1, 0), run_with(64, 1, 0)};
    EXPECT_EQ(searched(listed, {{"recall_1px", {0.9}}}, saturating).size(), 2U); // not reached
    EXPECT_EQ(searched(listed, {{"recall_1px", {0.5}}}, saturating).size(), 2U); // reached by the cheapest
    EXPECT_EQ(searched({run_with(7, 1, 0)}, {{"recall_1px", {0.5}}}, saturating).size(), 1U);
    // A run that failed has a row without the measure: it is not tried again.
    Experiment experiment;
    experiment.targets                 = {{"recall_1px", {0.8}}};
    std::vector<ssrlab::Run>      runs = listed;
    std::map<std::string, Record> rows;
    for (const ssrlab::Run& run : runs) rows[run.id] = {{"recall_1px", saturating(run)}};
    runs.push_back(next_probes(experiment, {&march, 1}, runs, rows).at(0));
    rows[runs.back().id] = {{"outcome", "failed"}};
    EXPECT_THAT(next_probes(experiment, {&march, 1}, runs, rows), testing::IsEmpty());
}

// Of values that differ in nothing else the next one is halfway by ratio, said by three digits.
TEST(Search, ReachesATargetThatIsMetExactly)
{
    const auto probed = [](std::vector<std::pair<double, double>> line, const std::string& measure, bool higher,
                           double target) {
        Experiment                    experiment;
        std::vector<ssrlab::Run>      runs;
        std::map<std::string, Record> rows;
        experiment.targets = {{measure, {target}, higher}};
        for (const auto& [stride_px, measured] : line) {
            runs.push_back(run_with(9, stride_px, 0));
            rows[runs.back().id] = {{measure, measured}};
        }
        // What another technique does has no part in it.
        runs.push_back(run_with(9, 3, 0));
        runs.back().technique = "other";
        runs.back().values.clear();
        runs.back().id       = run_id(runs.back());
        rows[runs.back().id] = {{measure, 0.0}};
        std::vector<double> strides_px;
        for (const ssrlab::Run& run : next_probes(experiment, {&march, 1}, runs, rows))
            strides_px.push_back(run.values.at("stride_px"));
        return strides_px;
    };
    EXPECT_THAT(probed({{10, 0.5}, {1, 0.9}, {0.1, 0.95}}, "recall_1px", true, 0.9), testing::ElementsAre(3.16));
    EXPECT_THAT(probed({{10, 0.3}, {1, 0.1}, {0.1, 0.05}}, "flip_visible", false, 0.1), testing::ElementsAre(3.16));
}

TEST(Search, KnowsWhichWayAMeasureIsBetter)
{
    for (const TargetMeasure& measure : target_measures())
        EXPECT_EQ(measure.higher_is_better, !measure.name.starts_with("flip")) << measure.name;
}

TEST(Search, HasNothingBetweenNeighbouringWholeNumbers)
{
    const ssrlab::Run listed[] = {run_with(1, 1, 0), run_with(2, 1, 0)};
    EXPECT_FALSE(find_probe({&march, 1}, listed, "r0123456789abcdef"));
}

TEST(Search, EveryRunThatItAddsIsFoundByItsId)
{
    const std::vector<ssrlab::Run> listed = {run_with(16, 1, 0), run_with(256, 1, 0), run_with(4096, 1, 0),
                                             run_with(16, 4, 0)};
    const auto                     all    = searched(listed, {{"recall_1px", {0.9, 0.98}, true}}, saturating);
    ASSERT_GT(all.size(), listed.size() + 3);
    for (size_t i = listed.size(); i < all.size(); ++i) {
        const auto found = find_probe({&march, 1}, listed, all[i].id);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->values, all[i].values);
    }
    EXPECT_FALSE(find_probe({&march, 1}, listed, "r0123456789abcdef"));
}

} // namespace
} // namespace ssrlab
