// The one quantile of the project.
#pragma once

#include <vector>

namespace ssrlab {

/// The value below which a share p of the values lies, interpolated linearly; NaN without values.
double quantile(std::vector<double> values, double p);

} // namespace ssrlab
