// One case run: what its row counts, and what it reports where a technique or a case is wrong.
#include "check/ray_report.h"
#include "check/report.h"
#include "check/run_check.h"
#include "core/files.h"
#include "gpu/device.h"
#include "unit/temp_folder.h"

namespace ssrlab::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Poles from 4 to 5 m in columns 20 and 30. Of the rays at 4.5 m in row 10 the first meets a pole after 15 pixels, at t = 14.5 / 50; the second
/// crosses 20 pixels and meets nothing; the third meets a pole after 9 pixels, at t = 8.5 / 30.
ssrlab::Setup poles()
{
    ssrlab::Setup setup{"level",
                        picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 20 || p.x == 30 ? 4.0 : 0.0; }),
                        boxes({.thickness_m = 1, .max_distance_m = 100}),
                        {}};
    const View&   view = setup.gbuffer.view;
    setup.rays         = {level_ray(view, {5.5, 10.5}, {50, 0}, 4.5), level_ray(view, {40.5, 10.5}, {20, 0}, 4.5),
                          level_ray(view, {21.5, 10.5}, {30, 0}, 4.5)};
    return setup;
}

HardCase case_of_poles()
{
    return {.name = "poles", .breaks = "", .answer = "", .setups = [] { return std::vector{poles()}; }};
}

HardCase case_expecting(const Expected& expected)
{
    HardCase hard_case = case_of_poles();
    hard_case.expected = [=](const ssrlab::Setup&, const RayInput& ray) {
        return ray.pixel.x == 5 ? std::optional(expected) : std::nullopt;
    };
    return hard_case;
}

CaseRow run(const Technique& technique, const HardCase& hard_case, bool double_precision = true)
{
    return run_case(device(), catalogue(), technique, default_values(technique), "family", hard_case,
                    {.double_precision = double_precision});
}

CaseRow run(const HardCase& hard_case) { return run(technique("dda"), hard_case); }

/// The pixel walk, whose result then goes through `wrong`: statements with `ray` and `r`.
class Walk {
public:
    explicit Walk(const std::string& wrong, const std::string& limits = "")
    {
        const auto& walk     = test::technique("dda").folder;
        std::string manifest = read_file(walk / "technique.toml"), trace = read_file(walk / "trace.glsl");
        const auto  replace = [](std::string& text, const std::string& from, const std::string& to) {
            text.replace(text.find(from), from.size(), to);
        };
        replace(manifest, "exact      = true", limits.empty() ? "exact = true" : limits);
        replace(trace, "TraceResult trace(Ray ray)", "TraceResult walked(Ray ray)");
        folder_.write("walk/technique.toml", manifest);
        folder_.write("walk/trace.glsl",
                      trace + "TraceResult trace(Ray ray) { TraceResult r = walked(ray); " + wrong + " return r; }\n");
        technique_ = load_technique(folder_ / "walk", catalogue().structures);
    }
    const Technique& operator*() const { return technique_; }

private:
    TempFolder folder_;
    Technique  technique_;
};

TEST(RunCase, ARowCountsItsRays)
{
    const CaseRow row = run(case_of_poles());
    EXPECT_EQ(row.family + " " + row.case_name + " " + row.technique, "family poles dda");
    EXPECT_EQ(row.rays, 3U);
    EXPECT_EQ(row.findable, 2U);
    EXPECT_EQ(row.found, 2U);
    EXPECT_EQ(row.wrong + row.slivers + row.allowed + row.non_finite + row.out_of_steps + row.precision_changes, 0U);
    EXPECT_EQ(row.most_steps, 20U);
    EXPECT_LT(row.worst_deviation_px, 1e-4); // t is a float: 2^-24 of 50 px
    EXPECT_EQ(row.breaks, 0U) << table_findings(row);
    EXPECT_EQ(row.digest,
              digest_of(device(), catalogue(), technique("dda"), default_values(technique("dda")), case_of_poles()));
}

TEST(RunCase, ABudgetThatTheUserChoseIsNoMistake)
{
    HardCase few      = case_of_poles();
    few.adjust        = [](const Technique&, ParameterValues& values) { values["max_steps"] = 10.0; };
    const CaseRow row = run(few);
    EXPECT_EQ(row.breaks, 0U) << table_findings(row);
    EXPECT_EQ(row.out_of_steps, 2U);
    EXPECT_EQ(row.most_steps, 10U);
    const CaseRow early = run(*Walk("r = out_of_steps(7);"), case_of_poles());
    EXPECT_EQ(early.out_of_steps, 3U);
    EXPECT_THAT(early.findings.at(0), HasSubstr("out of steps within its budget"));
}

// Equal steps in space are no equal steps on screen: of a ray toward the camera, the last one is the longest.
TEST(RunCase, StepsInSpaceMayBeLongerOnScreen)
{
    const Technique& linear = technique("linear");
    ParameterValues  values = default_values(linear);
    values.at("interval")   = 1;
    for (const char* name : {"through_the_near_plane", "behind_the_eye", "off_centre"})
        EXPECT_EQ(
            run_case(device(), catalogue(), linear, values, "", find_case(name), {.double_precision = false}).breaks,
            0U)
            << name;
}

TEST(RunCase, ProvenIterationsAreABound)
{
    for (int most : {19, 20}) {
        HardCase bounded   = case_of_poles();
        bounded.most_steps = [=](const ssrlab::Setup&) { return most; };
        const CaseRow row  = run(bounded);
        EXPECT_EQ(row.breaks, most == 19 ? 1U : 0U);
        if (most == 19) {
            EXPECT_THAT(row.findings, ElementsAre(HasSubstr("level, ray 0:1: 20 iterations, at most 19 are proven")));
        }
    }
    // Without a bound of the case: two cells for each of 127 pixels, and 16 levels at the most.
    EXPECT_EQ(run(*Walk("r.steps = 254;"), case_of_poles()).breaks, 0U);
    EXPECT_EQ(run(*Walk("r.steps = 271;"), case_of_poles()).breaks, 3U);
}

TEST(RunCase, AClosedFormIsComparedInAllItsParts)
{
    const auto breaks = [](const Expected& expected) { return run(case_expecting(expected)).breaks; };
    EXPECT_EQ(breaks({.pixel = glm::ivec2(20, 10), .t = 0.29, .end_px = glm::dvec2(55.5, 10.5)}), 0U);
    EXPECT_EQ(breaks({.t = 0.29 + 0.9e-4, .end_px = glm::dvec2(55.5009, 10.5)}), 0U);
    EXPECT_EQ(breaks({.t = 0.29 + 1.1e-4}), 1U);
    EXPECT_EQ(breaks({.pixel = glm::ivec2(20, 11)}), 1U);
    EXPECT_EQ(breaks({.end_px = glm::dvec2(55.5011, 10.5)}), 1U);
    EXPECT_EQ(breaks({.status = TraceStatus::left_screen}), 1U);
    EXPECT_EQ(breaks({.status = std::nullopt, .pixel = glm::ivec2(20, 11)}), 0U);
    // Who claims limits is held to them by the judge; where a ray ends was not its doing.
    const Walk limited("", "limits = [\"point_sampled\"]");
    EXPECT_EQ(run(*limited, case_expecting({.pixel = glm::ivec2(20, 11)})).breaks, 0U);
    EXPECT_EQ(run(*limited, case_expecting({.end_px = glm::dvec2(56, 10.5)})).breaks, 1U);
}

TEST(RunCase, RaysMustBeSoundlySetUp)
{
    const auto breaks = [](auto change) {
        HardCase hard_case = case_of_poles();
        hard_case.setups   = [=] {
            auto setup = poles();
            change(setup.rays[0]); // which meets a pole before its end
            return std::vector{setup};
        };
        return run(hard_case).breaks;
    };
    EXPECT_EQ(breaks([](RayInput& ray) { ray.delta_px_depth.x = 58.5005; }), 0U);
    EXPECT_EQ(breaks([](RayInput& ray) { ray.delta_px_depth.x = 58.502; }), 1U);
    EXPECT_EQ(breaks([](RayInput& ray) { ray.length_m = -1; }), 1U);
}

TEST(RunCase, RelationsMustHoldBitByBit)
{
    const auto related = [](const Relation& relation, const Technique& of) {
        HardCase hard_case  = case_of_poles();
        hard_case.relations = {relation};
        return run(of, hard_case);
    };
    const auto same   = [](const ssrlab::Setup& setup) { return setup; };
    const auto next   = [](RayOutcome outcome) { return outcome.t = std::nextafter(outcome.t, 1), outcome; };
    const auto left   = [](RayOutcome outcome) { return --outcome.hit_pixel.x, outcome; };
    const auto breaks = [&](const Relation& relation) { return related(relation, technique("dda")).breaks; };
    EXPECT_EQ(breaks({.name = "same", .change = same}), 0U);
    EXPECT_EQ(breaks({.name = "t", .change = same, .back = next}), 2U);
    EXPECT_EQ(breaks({.name = "t", .change = same, .back = next, .compare_t = false}), 0U);
    EXPECT_EQ(breaks({.name = "pixel", .change = same, .back = left, .compare_t = false}), 2U);
    const auto empty = [](ssrlab::Setup setup) {
        return setup.gbuffer.depth.assign(setup.gbuffer.depth.size(), 0), setup;
    };
    EXPECT_EQ(breaks({.name = "status", .change = empty}), 2U);
    const auto fewer = [](ssrlab::Setup setup) { return setup.rays.pop_back(), setup; };
    EXPECT_THAT(related({.name = "fewer", .change = fewer}, technique("dda")).findings,
                ElementsAre(HasSubstr("fewer: 3 rays became 2")));
    EXPECT_EQ(related({.name = "t", .change = same, .back = next}, *Walk("", "limits = [\"point_sampled\"]")).breaks,
              0U);
}

TEST(RunCase, MirrorImagesMustAgree)
{
    const CaseRow x = run(*Walk("if (ray.delta.x < real(0)) r = miss(ray, 1);"), case_of_poles());
    EXPECT_EQ(x.breaks, 2U);
    EXPECT_THAT(x.findings.at(0), HasSubstr("but its mirror image in x says left_screen"));
    const CaseRow y = run(*Walk("if (ray.origin.y > real(32)) r = miss(ray, 1);"), case_of_poles());
    EXPECT_EQ(y.breaks, 2U);
    EXPECT_THAT(y.findings.at(0), HasSubstr("but its mirror image in y says left_screen"));
    // What its limits allow is right in a mirror, too; a hit of nothing never is.
    const std::string limits = "limits = [\"point_sampled\"]";
    EXPECT_EQ(run(*Walk("if (ray.delta.x < real(0)) r = miss(ray, 1);", limits), case_of_poles()).breaks, 0U);
    const CaseRow wrong = run(*Walk("if (ray.delta.x < real(0)) r = TraceResult(TRACE_HIT, "
                                    "ray.start_pixel - ivec2(3, 0), real(1), 1);",
                                    limits),
                              case_of_poles());
    EXPECT_EQ(wrong.breaks, 3U);
    EXPECT_THAT(wrong.findings.at(0), HasSubstr("its mirror image in x is wrong"));
}

TEST(RunCase, VerdictsAreCounted)
{
    const CaseRow misses = run(*Walk("r = miss(ray, r.steps);"), case_of_poles());
    EXPECT_EQ(misses.findable, 2U);
    EXPECT_EQ(misses.found, 0U);
    EXPECT_EQ(misses.wrong, 2U);
    EXPECT_THAT(check_finds({misses}), ElementsAre(HasSubstr("finds none of 2 hits")));
    CaseRow other = misses;
    other.found   = 1;
    EXPECT_THAT(check_finds({misses, other}), IsEmpty()) << "it finds something in another case";
    const CaseRow allowed = run(*Walk("r = miss(ray, r.steps);", "limits = [\"point_sampled\"]"), case_of_poles());
    EXPECT_EQ(allowed.allowed, 2U);
    EXPECT_EQ(allowed.wrong + allowed.breaks, 0U);
    EXPECT_NE(allowed.digest, run(case_of_poles()).digest);
    // Still in the pixel: 0.005 of 50 px, and of 30 px, from where the walk meets it. Steps, too, are part of the digest.
    const CaseRow later = run(*Walk("if (r.status == TRACE_HIT) r.t += real(0.005);"), case_of_poles());
    EXPECT_NEAR(later.worst_deviation_px, 0.25, 1e-4);
    EXPECT_EQ(later.found, 2U);
    EXPECT_EQ(later.breaks, 0U) << table_findings(later);
    const CaseRow slower = run(*Walk("r.steps += 1;"), case_of_poles());
    EXPECT_EQ(slower.most_steps, 21U);
    EXPECT_NE(slower.digest, run(case_of_poles()).digest);
    // Findings are the first four, and name the setup.
    HardCase twice = case_of_poles();
    twice.setups   = [] {
        auto empty = poles();
        empty.gbuffer.depth.assign(empty.gbuffer.depth.size(), 0);
        return std::vector{empty, poles(), poles(), poles()};
    };
    const CaseRow many = run(*Walk("r = miss(ray, r.steps);"), twice);
    EXPECT_EQ(many.rays, 12U);
    EXPECT_EQ(many.wrong, 6U);
    ASSERT_EQ(many.findings.size(), 4U);
    EXPECT_THAT(many.findings[0], HasSubstr("level, ray 1:0: "));
    EXPECT_THAT(many.findings[3], HasSubstr("level, ray 2:2: "));
    EXPECT_THAT(table_findings(many), HasSubstr("… and 2 more"));
}

TEST(RunCase, FloatAndDoubleAreCompared)
{
    // Depth is about 0.02: adding a part in 10^12 changes it in double alone.
    const Walk walk("real z = ray.origin.z; precise real more = z + z * real(1e-12); if (more != z) r = miss(ray, 1);");
    EXPECT_EQ(run(*walk, case_of_poles()).precision_changes, device().info.float64 ? 2U : 0U);
    EXPECT_EQ(run(*walk, case_of_poles(), false).precision_changes, 0U);
}

TEST(RayReport, SaysWhatTheRayMet)
{
    const auto        setup       = poles();
    const RayQuestion questions[] = {{&technique("dda"), default_values(technique("dda"))},
                                     {&technique("hiz"), default_values(technique("hiz"))}};
    const RayReport   report      = report_ray(device(), catalogue(), setup, setup.rays[0], questions);
    ASSERT_EQ(report.walk.size(), 50U);
    const VisitReport &first = report.walk[0], &pole = report.walk[14];
    EXPECT_EQ(first.front_m, 0) << "background";
    EXPECT_EQ(first.back_m, 0);
    EXPECT_EQ(pole.visit.pixel, glm::ivec2(20, 10));
    // Depths are floats: 2^-24 of 5 m, twice.
    EXPECT_NEAR(pole.t_in, 0.29, 1e-6);
    EXPECT_NEAR(pole.t_out, 0.31, 1e-6);
    EXPECT_NEAR(pole.ray_in_m, 4.5, 1e-6);
    EXPECT_NEAR(pole.ray_out_m, 4.5, 1e-6);
    EXPECT_NEAR(pole.front_m, 4, 1e-6);
    EXPECT_NEAR(pole.back_m, 5, 1e-5);
    const TechniqueReport &dda = report.techniques.at(0), &hiz = report.techniques.at(1);
    EXPECT_EQ(dda.verdict, "the hit contract's answer");
    ASSERT_EQ(dda.visits.size(), 15U);
    EXPECT_EQ(dda.visit_count, 15U);
    for (size_t i = 0; i < 15; ++i) EXPECT_STREQ(dda.visits[i].then, i < 14 ? "passes" : "hit") << i;
    EXPECT_THAT(dda.ending, HasSubstr("hit at pixel (20, 10), t 0.290000, 14.500 px on screen, 4.5 m from the camera"));
    bool opened = false;
    for (size_t i = 0; i < hiz.visits.size(); ++i) {
        const VisitReport& visit = hiz.visits[i];
        const int  side = 1 << visit.visit.level, x = visit.visit.pixel.x >> visit.visit.level << visit.visit.level;
        const bool holds = (x <= 20 && 20 < x + side) || (x <= 30 && 30 < x + side);
        EXPECT_NEAR(visit.front_m, holds ? 4 : 0, 1e-6) << i;
        EXPECT_NEAR(visit.back_m,
                    !holds                  ? 0
                    : visit.visit.level > 0 ? 4
                                            : 5,
                    1e-5)
            << i; // of a cell its farthest pixel
        EXPECT_LE(visit.t_in, visit.t_out);
        opened = opened || visit.then == std::string("opens");
        if (visit.then == std::string("opens")) {
            EXPECT_LT(hiz.visits.at(i + 1).visit.level, visit.visit.level);
            EXPECT_TRUE(holds) << "an empty cell is skipped";
        }
    }
    EXPECT_TRUE(opened);
    EXPECT_STREQ(hiz.visits.back().then, "hit");
}

TEST(RunCase, TablesHoldEachCountInItsColumn)
{
    const CaseRow row{.family             = "f",
                      .case_name          = "c",
                      .technique          = "t",
                      .rays               = 1,
                      .findable           = 2,
                      .found              = 3,
                      .wrong              = 4,
                      .slivers            = 5,
                      .allowed            = 6,
                      .worst_deviation_px = 7,
                      .non_finite         = 8,
                      .out_of_steps       = 9,
                      .most_steps         = 10,
                      .precision_changes  = 11,
                      .seconds            = 12,
                      .breaks             = 13};
    EXPECT_THAT(markdown_table({row}),
                HasSubstr("| f | c | t | 1 | 2 | 3 | 4 | 5 | 6 | 7.000 | 8 | 9 | 10 | 11 | 13 broken |"));
    std::string line = table_line(row);
    line.erase(std::unique(line.begin(), line.end(), [](char a, char b) { return a == ' ' && b == ' '; }), line.end());
    EXPECT_EQ(line, "f c t 1 2 3 4 5 6 7.000 8 9 10 11 12.00 FAILS");
}

} // namespace
} // namespace ssrlab::test
