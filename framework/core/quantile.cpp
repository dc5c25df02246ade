#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ssrlab {

double quantile(std::vector<double> values, double p)
{
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const double position = p * static_cast<double>(values.size() - 1);
    const auto   below    = values.begin() + static_cast<std::ptrdiff_t>(position);
    std::ranges::nth_element(values, below);
    const auto above = below + 1 == values.end() ? below : std::min_element(below + 1, values.end());
    return std::lerp(*below, *above, position - std::floor(position));
}

} // namespace ssrlab
