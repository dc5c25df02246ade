// passes.csv: the passes of each run's frame in their order, a row each: whether it ran, how long it took, and why.
#pragma once

#include "harness/measured_run.h"
#include "harness/record.h"

#include <map>
#include <string>
#include <string_view>

namespace ssrlab {

std::span<const Column> pass_columns();

std::string passes_text(const MeasuredRun& measured);

/// How many passes of each run ran, by run id. `records`: the file without its header; a torn last record is left out.
std::map<std::string, int64_t> count_passes(std::string_view records);

} // namespace ssrlab
