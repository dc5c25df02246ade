// What the check measures besides right and wrong: answers under sub-pixel jitter, and on depth in other formats.
#include "check/stability.h"
#include "check/depth_format.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

TEST(DepthFormats, LoseNoMoreThanHalfAStep)
{
    constexpr double near_m = 0.1, far_m = 60;
    for (const DepthFormat& format : depth_formats()) {
        double worst = 0, half_step = 0.5 / (std::ldexp(1.0, format.bits) - 1);
        if (format.bits == 32) half_step = std::ldexp(1.0, -25); // of a float in [1/2, 1)
        for (int i = 0; i <= 10'000; ++i) {
            const double depth    = near_m / (near_m + (far_m - near_m) * i / 10'000.0);
            const auto   rounded  = static_cast<float>(depth);
            const float  imported = stored_and_imported(format, rounded, near_m, far_m);
            worst = std::max(worst, std::abs(static_cast<double>(imported) - static_cast<double>(rounded)));
        }
        // The import itself rounds to float.
        EXPECT_LE(worst, half_step + std::ldexp(1.0, -25)) << format.name;
        // The project's own format loses nothing; a reversed float rounds as the import does.
        if (format.infinite) {
            EXPECT_EQ(worst, 0) << format.name;
        }
        if (!format.reversed || format.bits < 32) {
            EXPECT_GE(worst, 0.9 * half_step) << format.name;
        }
    }
    EXPECT_EQ(stored_and_imported(depth_formats().back(), 0.0F, near_m, far_m), 0.0F) << "background stays";
}

TEST(DepthFormats, CostMoreTheFewerTheirBits)
{
    const auto rows = measure_formats(device(), catalogue(), technique("dda"));
    ASSERT_EQ(rows.size(), 2 * depth_formats().size());
    for (size_t group : {0, 1}) {
        const auto  first = rows.begin() + static_cast<std::ptrdiff_t>(group * depth_formats().size());
        const auto &own = first[0], &float_reversed = first[1], &float_standard = first[2], &d24 = first[4],
                   &d16 = first[6];
        EXPECT_EQ(own.changed_per_million, 0);
        EXPECT_EQ(own.p99_error, 0);
        EXPECT_LE(float_reversed.p99_error, 1e-6);
        EXPECT_LE(float_reversed.changed_per_million, float_standard.changed_per_million);
        EXPECT_LE(float_standard.p99_error, d24.p99_error * 1.1);
        EXPECT_LT(d24.changed_per_million, d16.changed_per_million);
        EXPECT_LT(d24.p99_error, d16.p99_error);
        EXPECT_GT(own.rays, 10'000U);
    }
}

TEST(Jitter, ExactTechniquesShareTheSamplingsOwnFlicker)
{
    const JitterRow walk = measure_jitter(device(), catalogue(), technique("dda")),
                    hiz  = measure_jitter(device(), catalogue(), technique("hiz"));
    EXPECT_EQ(walk.pixels, hiz.pixels);
    EXPECT_EQ(walk.flips_percent, hiz.flips_percent);
    EXPECT_EQ(walk.p99_spread_px, hiz.p99_spread_px);
    EXPECT_GT(walk.pixels, 5000U);
    EXPECT_GT(walk.flips_percent, 0);
    EXPECT_LT(walk.flips_percent, 2);
    EXPECT_NEAR(walk.median_spread_px, 0.4, 0.1) << "a plane mirror moves hits as the jitter moves the pixel";
}

TEST(Jitter, ATechniqueThatMissesFlickersMore)
{
    EXPECT_GT(measure_jitter(device(), catalogue(), technique("linear_binary")).flips_percent,
              2 * measure_jitter(device(), catalogue(), technique("dda")).flips_percent);
}

} // namespace
} // namespace ssrlab::test
