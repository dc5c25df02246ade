// The one quantile of the project.
#pragma once

#include <vector>

namespace ssrlab {

/// Returns the value below which a share `p` of the values lies, interpolated linearly; NaN if there are no values.
double quantile(std::vector<double> values, double p);

} // namespace ssrlab
