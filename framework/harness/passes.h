// passes.csv: one row for each pass of each run's frame: whether it ran, how long it took, and why.
#pragma once

#include "harness/measured_run.h"
#include "harness/record.h"

#include <map>
#include <string>
#include <string_view>

namespace ssrlab {

std::span<const Column> pass_columns();

std::string passes_text(const MeasuredRun& measured);

/// Returns the number of passes that ran, by run id. `records`: the file without header; a torn last one is left out.
std::map<std::string, int64_t> count_passes(std::string_view records);

} // namespace ssrlab
