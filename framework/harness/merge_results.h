// Merging the parts of one experiment.
#pragma once

#include <filesystem>
#include <vector>

namespace ssrlab {

/// Writes everything in `folders` (run --shard) into the new folder `merged`, which run --resume can then complete.
/// Prints the number of rows; returns 0. Throws SpecError, before anything is written, if `merged` has results, if the
/// folders differ in columns or in what resuming compares (specification, shaders, scenes, device), and if two of them
/// have the same run.
int merge_results(const std::filesystem::path& merged, const std::vector<std::filesystem::path>& folders);

} // namespace ssrlab
