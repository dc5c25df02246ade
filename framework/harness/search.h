// The search for the cheapest setting that reaches a target.
#pragma once

#include "harness/experiment.h"
#include "harness/record.h"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace ssrlab {

/// A measure that [targets] may name, and which direction is better.
struct TargetMeasure {
    std::string name; // also the column
    bool        higher_is_better;
};
std::span<const TargetMeasure> target_measures();

/// Ratio of two neighbouring values, of which one reaches the target, at which the search ends.
inline constexpr double search_ratio = 1.1;

/// Returns the runs for one step of a bisection on one frame; empty if nothing is left to try. Runs that differ only in
/// an accuracy parameter form a line. For each line and target, the next run is halfway between the first value that
/// reaches the target and the one before, unless these are within search_ratio. The search stays in the range of the
/// listed values. `runs`: all of the frame, with those of earlier steps; `rows`: their rows by id.
std::vector<Run> next_probes(const Experiment& experiment, std::span<const Technique> techniques,
                             std::span<const Run> runs, const std::map<std::string, Record>& rows);

/// Returns the run with this id among all that the search may add to `listed`; nullopt if it never makes such a run.
std::optional<Run> find_probe(std::span<const Technique> techniques, std::span<const Run> listed,
                              const std::string& id);

} // namespace ssrlab
