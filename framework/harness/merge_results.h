// Results of one experiment that was run in parts, put together.
#pragma once

#include <filesystem>
#include <vector>

namespace ssrlab {

/// Writes rows, samples, passes, summaries of sequences and pictures of all `folders` (run --shard) into the new folder `merged`. It is then as if one
/// program had written it: run --resume does what is still missing. Prints the number of rows; returns 0.
/// Throws SpecError, before anything is written, when `merged` has results, when folders differ in what resuming compares (specification,
/// shaders, scenes, device) or in their columns, and when a run is in two of them.
int merge_results(const std::filesystem::path& merged, const std::vector<std::filesystem::path>& folders);

} // namespace ssrlab
