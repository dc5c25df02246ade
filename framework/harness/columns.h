// Every column of results.csv, once: name with unit, what it means, and the type of its values.
#pragma once

#include "harness/experiment.h"
#include "harness/record.h"

namespace ssrlab {

/// Identity, settings and parameters of the experiment's techniques: what tells rows apart.
std::vector<Column> setting_columns(const Experiment& experiment, std::span<const Technique> techniques);

/// Identity, settings, parameters, measures, outcome, message: known before the first row. Parameters are those of the
/// experiment's techniques. Throws SpecError when one has the name of another column.
std::vector<Column> result_columns(const Experiment& experiment, std::span<const Technique> techniques);

} // namespace ssrlab
