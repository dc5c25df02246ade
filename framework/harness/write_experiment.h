// An experiment as a file: runs back to the TOML that load_experiment() reads.
#pragma once

#include "harness/experiment.h"

namespace ssrlab {

/// Returns a specification whose runs are each of `settings` on each of `pictures` (any run on each; all frames of all
/// views of a scene, in one size). Values at their defaults are left out. `measure`: the table [measure], or empty.
std::string experiment_text(const std::string& name, std::span<const Run> pictures, std::span<const Run> settings,
                            std::span<const Setting> known, std::span<const Technique> techniques,
                            const std::string& measure);

} // namespace ssrlab
