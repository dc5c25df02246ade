#include "harness/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

} // namespace

int interval_rank(int count)
{
    // log of C(count, i) / 2^count, so that large counts do not underflow to a sum of zero.
    const auto log_probability = [&](int i) {
        return std::lgamma(count + 1) - std::lgamma(i + 1) - std::lgamma(count - i + 1) - count * std::log(2.0);
    };
    double below = 0;
    int    rank  = 0;
    while (rank < count) {
        below += std::exp(log_probability(rank));
        if (2 * below > 0.05) break;
        ++rank;
    }
    return rank;
}

Summary summarise(std::vector<double> samples)
{
    std::ranges::sort(samples);
    const int count = static_cast<int>(samples.size());
    Summary   summary{count, quantile(samples, 0.5), unknown, unknown, unknown};
    if (const int rank = interval_rank(count); rank > 0) {
        summary.ci_low  = samples[static_cast<size_t>(rank - 1)];
        summary.ci_high = samples[static_cast<size_t>(count - rank)];
    }
    for (double& sample : samples) sample = std::abs(sample - summary.median);
    summary.mad = quantile(std::move(samples), 0.5);
    return summary;
}

} // namespace ssrlab
