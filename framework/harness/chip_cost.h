// What a setting costs on a chip that is not there: the instructions that its compiler makes, times the iterations that
// were counted.
#pragma once

#include "harness/experiment.h"
#include "harness/record.h"

namespace ssrlab {

/// Instructions of structures and trace, each once for an invocation, also in a loop.
struct ChipCode {
    double of_pixel = 0; // structures of the depth
    double of_ray   = 0; // structures of rays, and the trace
    double loop     = 0; // of a ray: those of the trace's innermost loop
    int    wave     = 0; // rays in lockstep
};

/// Compiles the frame of a run. chip: a device that only compiles (gpu/compiled.h). Throws SpecError for a technique
/// that does not compile, Failure for one that the chip cannot run.
ChipCode compile_for_chip(Gpu& chip, const Catalogue& catalogue, const Run& run);

/// Returns the instructions per ray of a row of results.csv: each once, and those of the loop once for each iteration
/// of the longest ray of a wave. Returns nullopt for a row without rays.
std::optional<double> instructions_of(const ChipCode& code, const Record& row, glm::ivec2 size_px);

} // namespace ssrlab
