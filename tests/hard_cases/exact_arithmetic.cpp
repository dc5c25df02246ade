// arithmetic = exact beyond the campaign: on every hard case, and on a device that cannot.
#include "check/run_check.h"
#include "gpu/device.h"

#include <gmock/gmock.h>

namespace ssrlab::test {
namespace {

TEST(ExactArithmetic, HoldsOnEveryHardCase)
{
    for (const std::string id : {"dda", "hiz"})
        for (const CaseFamily& family : hard_cases())
            for (const HardCase& hard_case : family.cases) {
                const CaseRow row = run_case(device(), technique(id), values_of(technique(id), {{"arithmetic", 1}}),
                                             family.name, hard_case, {.double_precision = false});
                EXPECT_EQ(row.wrong, 0U) << hard_case.name;
                // At twice the resolution ends lie on a finer grid: the same pixels, but other last bits of t.
                if (hard_case.name == "resolution_doubling") continue;
                EXPECT_EQ(row.breaks, 0U) << hard_case.name << " " << (row.findings.empty() ? "" : row.findings[0]);
            }
}

TEST(ExactArithmetic, IsRefusedWhereTheDeviceHasNoIntegersForIt)
{
    const Technique& walk    = technique("dda");
    const auto       gbuffer = upload_depth(device(), bench_view(), std::vector<float>(64 * 64, 0.0F));
    Gpu              without = device();
    without.info.int64       = false;
    EXPECT_NO_THROW(make_ray_tracer(without, gbuffer, walk, default_values(walk), {}, 1));
    EXPECT_THAT(
        [&] {
            make_ray_tracer(without, gbuffer, walk, values_of(walk, {{"arithmetic", 1}}), {}, 1);
        },
        testing::ThrowsMessage<Failure>(
            testing::AllOf(testing::HasSubstr("arithmetic = exact"), testing::HasSubstr("shaderInt64"))));
}

} // namespace
} // namespace ssrlab::test
