// Every column of results.csv, once: name with unit, meaning, and type of its values.
#pragma once

#include "harness/experiment.h"
#include "harness/record.h"

namespace ssrlab {

/// Returns the columns that tell rows apart: identity, settings and parameters of the experiment's techniques.
std::vector<Column> setting_columns(const Experiment& experiment, std::span<const Technique> techniques);

/// Returns all columns: identity, settings, parameters of the experiment's techniques, measures, outcome, message.
/// Throws SpecError if a parameter has the name of another column.
std::vector<Column> result_columns(const Experiment& experiment, std::span<const Technique> techniques);

} // namespace ssrlab
