// All runs on one frame: they share scene, view and size, so the G-buffer is made once and timings compare.
#pragma once

#include "harness/measured_run.h"
#include "harness/progress.h"
#include "harness/quality.h"
#include "harness/result_folder.h"
#include "harness/sequence_state.h"
#include "harness/supervise.h"

#include <optional>
#include <random>
#include <set>
#include <string>

namespace ssrlab {

/// The scene in use, kept until another one is needed.
struct LoadedScene {
    std::string name;
    Stage       stage;
};

/// The mean image with the true reflection over all phases of the jitter.
struct ConvergedPicture {
    TraceSettings settings; // under which it was made
    Reference     picture;
};

/// What all steps of a sweep share.
struct SweepContext {
    const Experiment&                    experiment;
    const Catalogue&                     catalogue;
    std::span<const Technique>           techniques;
    Gpu&                                 gpu;
    ResultFolder&                        results;
    Progress&                            progress;
    SweepState&                          state;
    std::map<std::string, std::string>   identity; // as in environment.json
    std::mt19937_64                      random{experiment.measure.seed};
    std::unique_ptr<LoadedScene>         scene = nullptr;
    std::map<std::string, SequenceState> sequences =
        {}; // of one scene, view and size, by sequence_id(); empty for a single frame
    std::vector<ConvergedPicture> converged = {}; // likewise; empty if more than the jitter moves
    std::set<std::string>         said      = {}; // techniques without hits and missing channels, each said once
    // Wall time of timing, of counting and judging, and of making or reading truths.
    double timed_s = 0, counted_s = 0, truths_s = 0;
};

/// Appends the row of a finished run.
void finish(SweepContext& sweep, const Run& run, const Record& row, const RunLines& lines = {});

/// Measures the runs without a row, and those that a search for targets adds, and appends each row when it is final. A
/// run that fails is a row with the reason. Returns early, with complete rows, if a stop was requested. `replayed`:
/// runs whose frame is only run for the next frame of their sequence.
void measure_picture(SweepContext& sweep, std::span<const Run> runs, std::span<const Run> replayed = {});

} // namespace ssrlab
