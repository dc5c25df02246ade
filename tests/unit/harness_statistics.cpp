// Statistics with answers known from tables or by argument.
#include "harness/statistics.h"
#include "test.h"

namespace ssrlab {
namespace {

TEST(Statistics, MedianAndDeviation)
{
    EXPECT_EQ(summarise({3}).median, 3);
    EXPECT_EQ(summarise({4, 1}).median, 2.5);
    const Summary summary = summarise({1, 1, 2, 2, 4, 6, 9}); // the textbook's example: median 2, MAD 1
    EXPECT_EQ(summary.median, 2);
    EXPECT_EQ(summary.mad, 1);
    EXPECT_EQ(summarise({5, 5, 5, 1000}).mad, 0); // one outlier moves nothing
    EXPECT_TRUE(std::isnan(summarise({}).median));
}

TEST(Statistics, RanksAsInTheSignTestsTable)
{
    for (int count = 0; count < 6; ++count) EXPECT_EQ(interval_rank(count), 0);
    // Critical values of the two-sided sign test at 5 %, plus one.
    const int known[][2] = {{6, 1},  {8, 1},  {9, 2},  {11, 2},  {12, 3},  {15, 4},
                            {17, 5}, {20, 6}, {25, 8}, {30, 10}, {50, 18}, {100, 40}};
    for (const auto& [count, rank] : known) EXPECT_EQ(interval_rank(count), rank) << count;
    EXPECT_NEAR(interval_rank(100000), 50000 - 1.96 * std::sqrt(100000) / 2, 2);
}

TEST(Statistics, IntervalIsOrderStatistics)
{
    const Summary six = summarise({6, 5, 4, 3, 2, 1});
    EXPECT_EQ(six.ci_low, 1);
    EXPECT_EQ(six.ci_high, 6);
    const Summary nine = summarise({9, 8, 7, 6, 5, 4, 3, 2, 1});
    EXPECT_EQ(nine.ci_low, 2);
    EXPECT_EQ(nine.ci_high, 8);
    EXPECT_TRUE(std::isnan(summarise({1, 2, 3, 4, 5}).ci_low));
}

TEST(Statistics, IntervalsCoverTheMedianAsOftenAsPromised)
{
    std::mt19937_64                       random(7);
    std::exponential_distribution<double> skewed(1);
    int                                   covered = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        std::vector<double> samples(15);
        for (double& sample : samples) sample = skewed(random);
        const Summary summary = summarise(samples);
        covered += summary.ci_low <= std::log(2.0) && std::log(2.0) <= summary.ci_high ? 1 : 0;
    }
    EXPECT_GE(covered, 4000 * 0.95); // exactly 96.5 % by the binomial sum
    EXPECT_LE(covered, 4000 * 0.98);
}

TEST(Statistics, Quantiles)
{
    EXPECT_EQ(quantile({4, 1, 3, 2, 5}, 0.5), 3);
    EXPECT_EQ(quantile({0, 10}, 0.25), 2.5);
    EXPECT_EQ(quantile({7}, 0.99), 7);
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

} // namespace
} // namespace ssrlab
