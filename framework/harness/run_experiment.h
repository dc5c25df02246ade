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
    std::string                        shard; // "2/8": the second of eight parts, cut between pictures; empty: all
    bool                               resume  = false;
    bool                               dry_run = false; // list runs and estimated time, touch nothing
    bool                               quiet   = false; // no progress
    bool                               yes     = false; // also more than max_runs_unasked
    std::string                        command_line;
};

/// 0 when every row is ok (or had nothing to trace), 1 when a run failed, 128 + the signal after one that asked to stop (130: SIGINT): the rows
/// so far are complete and --resume does the others. Throws SpecError before anything is written, Failure when writing is refused.
int run_experiment(const RunOptions& options);

} // namespace ssrlab
