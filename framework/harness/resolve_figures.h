// The tables [figures.NAME] of a specification, which `ssrlab plot` draws after the runs.
#pragma once

#include "harness/experiment.h"

#include <string>

namespace ssrlab {

/// Returns them as JSON, with the run_id that each panel names; empty without any. Throws SpecError with file and line
/// for a figure that could not be drawn from these runs.
std::string resolve_figures(const Experiment& experiment, std::span<const Technique> techniques,
                            std::span<const Run> runs);

} // namespace ssrlab
