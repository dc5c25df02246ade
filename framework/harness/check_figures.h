// The tables [figures.NAME] of a specification, which `ssrlab plot` draws after the runs.
#pragma once

#include "harness/experiment.h"

namespace ssrlab {

/// Throws SpecError with file and line for a figure that could not be drawn from these runs.
void check_figures(const Experiment& experiment, std::span<const Technique> techniques, std::span<const Run> runs);

} // namespace ssrlab
