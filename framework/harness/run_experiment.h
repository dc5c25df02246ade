// The main loop: every run of an experiment becomes a row.
#pragma once

#include "gpu/gpu.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct RunOptions {
    std::filesystem::path              specification;
    std::filesystem::path              folder;     // empty: results/NAME
    std::vector<std::filesystem::path> techniques; // more directories of techniques
    GpuOptions                         gpu;
    std::string                        only;  // a run id; empty: all runs
    std::string                        shard; // "2/8": the second of eight parts, cut between frames; empty: all
    bool                               resume  = false;
    bool                               dry_run = false; // list runs and estimated time, touch nothing
    bool                               quiet   = false; // no progress
    bool                               yes     = false; // also more than max_runs_unasked
    std::string                        command_line;
};

/// Returns 0 if every row is ok or had nothing to trace, 1 if a run failed, 128 + the signal that asked to stop (130:
/// SIGINT; --resume does the others). Throws SpecError before anything is written, and Failure if writing fails.
int run_experiment(const RunOptions& options);

} // namespace ssrlab
