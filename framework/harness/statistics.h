// Statistics of repeated timings, robust against outliers.
#pragma once

#include "core/quantile.h"

#include <cstdint>
#include <vector>

namespace ssrlab {

/// NaN: no samples, or too few for a confidence interval.
struct Summary {
    int    count  = 0;
    double median = 0;
    double mad    = 0;              // median absolute deviation from the median
    double ci_low = 0, ci_high = 0; // 95 % confidence interval of the median, from order statistics
};

Summary summarise(std::vector<double> samples);

/// Returns the largest rank k for which the k-th smallest and k-th largest of `count` samples enclose the median with
/// at least 95 % probability: 2 * P(Binomial(count, 1/2) < k) <= 5 %. 0 below six samples.
int interval_rank(int count);

} // namespace ssrlab
