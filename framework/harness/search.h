// Which settings must be tried for a target to be reached by the cheapest setting, not by the nearest point of a coarse sweep.
#pragma once

#include "harness/experiment.h"
#include "harness/record.h"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace ssrlab {

/// A measure that may stand in [targets], and which way is better.
struct TargetMeasure {
    std::string name; // also the column
    bool        higher_is_better;
};
std::span<const TargetMeasure> target_measures();

/// Two neighbours closer than this ratio are close enough: one that reaches the target, one that does not.
inline constexpr double search_ratio = 1.1;

/// One step of a bisection on one frame. Runs that differ in nothing but an accuracy parameter of their technique form a line. For each
/// line and target whose first value that reaches it follows one that does not, the run halfway between, unless the two are
/// close enough. The search never leaves the listed values' range. `runs`: all of the frame, those that earlier steps added
/// included; `rows`: what is known of them, by id. Empty when there is nothing left to try.
std::vector<Run> next_probes(const Experiment& experiment, std::span<const Technique> techniques,
                             std::span<const Run> runs, const std::map<std::string, Record>& rows);

/// The run with this id among all that the search may ever add to `listed`; nothing: it never makes such a run.
std::optional<Run> find_probe(std::span<const Technique> techniques, std::span<const Run> listed,
                              const std::string& id);

} // namespace ssrlab
