// The catalogue itself: its closed forms agree with the contract in double precision, and the tree's techniques hold what they claim.
#include "check/judge.h"
#include "check/report.h"
#include "check/run_check.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

const CaseFamily& family(const std::string& name) { return *std::ranges::find(hard_cases(), name, &CaseFamily::name); }

class Catalogue : public testing::TestWithParam<std::string> {};

std::vector<std::string> family_names()
{
    std::vector<std::string> names;
    for (const CaseFamily& f : hard_cases()) names.push_back(f.name);
    return names;
}

TEST_P(Catalogue, TechniquesHoldWhatTheyClaim)
{
    static Gpu robust = open_gpu({.device = {}, .validation = true, .robust_buffer_access = true});
    for (const HardCase& hard_case : family(GetParam()).cases)
        run_check(device(), &robust, {catalogue(), catalogue().techniques, hard_case.name, {}},
                  [&](const CaseRow& row) {
                      EXPECT_EQ(row.non_finite, 0U);
                      EXPECT_EQ(row.breaks, 0U) << table_line(row) << "\n" << table_findings(row);
                  });
    EXPECT_THAT(validation_messages(robust), testing::IsEmpty());
}

/// The expected answers are argued on paper; the double-precision walk, which knows nothing of the argument, must agree.
TEST_P(Catalogue, ClosedFormsAgreeWithTheContract)
{
    const Technique& walk = technique("dda");
    for (const HardCase& hard_case : family(GetParam()).cases) {
        if (!hard_case.expected) continue;
        size_t answered = 0;
        for (ssrlab::Setup setup : hard_case.setups()) {
            if (setup.rays.empty()) {
                const auto tracer = tracer_on(upload_gbuffer(device(), setup.gbuffer), walk, default_values(walk),
                                              setup.settings, setup.gbuffer.depth.size());
                setup.rays        = set_up_rays(device(), *tracer);
            }
            const Judge judge(setup);
            for (const RayInput& ray : setup.rays) {
                const auto expected = hard_case.expected(setup, ray);
                if (!expected || !expected->status) continue;
                ++answered;
                const RayOutcome exact = judge.exact_answer(ray);
                ASSERT_EQ(exact.status, *expected->status)
                    << hard_case.name << " " << setup.label << " ray of (" << ray.pixel.x << ", " << ray.pixel.y << ")";
                ASSERT_EQ(exact.hit_pixel, expected->pixel.value_or(exact.hit_pixel))
                    << hard_case.name << " " << setup.label;
                ASSERT_NEAR(exact.t, expected->t.value_or(exact.t), 1e-4) << hard_case.name << " " << setup.label;
            }
        }
        // no_usable_normal expects that certain rays do not exist; to_infinity knows where they end.
        const bool about_rays = hard_case.name == "no_usable_normal" || hard_case.name == "to_infinity";
        EXPECT_TRUE(answered > 0 || about_rays) << hard_case.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Families, Catalogue, testing::ValuesIn(family_names()),
                         [](const testing::TestParamInfo<std::string>& family_info) { return family_info.param; });

TEST(CatalogueEntries, RefusesWhatCannotWork) { EXPECT_THAT(check_refusals(), testing::IsEmpty()); }

TEST(CatalogueEntries, NamesAreUniqueAndEveryEntryExplainsItself)
{
    std::set<std::string> names;
    for (const CaseFamily& f : hard_cases())
        for (const HardCase& c : f.cases) {
            EXPECT_TRUE(names.insert(c.name).second) << c.name;
            EXPECT_GT(c.breaks.size(), 20U) << c.name;
            EXPECT_GT(c.answer.size(), 20U) << c.name;
        }
    EXPECT_THAT([] { find_case("grasing"); },
                testing::ThrowsMessage<SpecError>(testing::HasSubstr("did you mean 'grazing'?")));
}

} // namespace
} // namespace ssrlab::test
