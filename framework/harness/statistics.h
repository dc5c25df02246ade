// What repeated timings say: robust against the outliers that every machine produces.
#pragma once

#include "core/quantile.h"

#include <cstdint>
#include <vector>

namespace ssrlab {

/// NaN stands for "not known": no samples, or too few of them for an interval.
struct Summary {
    int    count  = 0;
    double median = 0;
    double mad    = 0;              // median absolute deviation from the median
    double ci_low = 0, ci_high = 0; // 95 % interval of the median, from order statistics: assumes no distribution
};

Summary summarise(std::vector<double> samples);

/// Rank k such that the k-th smallest and the k-th largest of `count` samples enclose the median with at least 95 %
/// probability: the largest k with 2 * P(Binomial(count, 1/2) < k) <= 5 %. 0 below six samples.
int interval_rank(int count);

} // namespace ssrlab
