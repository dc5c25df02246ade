// A picture without reflections, and what to change.
#pragma once

#include "frame/stage.h"

#include <string>

namespace ssrlab {

/// Returns what to say where fewer than one ray in a thousand hits anything, if the technique sees depth only at its
/// samples (`limits`); else "".
std::string no_hits_text(const Technique& technique, const TraceSettings& settings, const Scene& scene,
                         const TraceCounts& counts);

} // namespace ssrlab
