// All runs on one picture: scene, view and size are the same, so the G-buffer is made once and the timings are comparable.
#pragma once

#include "harness/measured_run.h"
#include "harness/progress.h"
#include "harness/quality.h"
#include "harness/result_folder.h"
#include "harness/sequence_state.h"
#include "harness/supervise.h"

#include <optional>
#include <random>

namespace ssrlab {

/// Kept from one picture to the next as long as the scene stays the same.
struct LoadedScene {
    std::string name;
    Stage       stage;
};

/// The mean of the pictures with the true reflection over all phases of the jitter.
struct ConvergedPicture {
    TraceSettings settings; // what it depends on, of all
    Reference     picture;
};

/// What all measuring works with.
struct SweepContext {
    const Experiment&                    experiment;
    const Catalogue&                     catalogue;
    std::span<const Technique>           techniques;
    Gpu&                                 gpu;
    ResultFolder&                        results;
    Progress&                            progress;
    SweepState&                          state;
    std::map<std::string, std::string>   identity; // what environment.json says
    std::mt19937_64                      random{experiment.measure.seed};
    std::unique_ptr<LoadedScene>         scene = nullptr;
    std::map<std::string, SequenceState> sequences =
        {}; // of one scene, view and size, by sequence_id(); empty for a single frame
    std::vector<ConvergedPicture> converged = {}; // of the same; empty where more than the jitter moves
    // Wall time of frames that were timed, of those that were judged and counted instead, and of making or reading truths.
    double timed_s = 0, counted_s = 0, truths_s = 0;
};

/// Appends the row of a run that is over.
void finish(SweepContext& sweep, const Run& run, const Record& row, std::string_view samples = "",
            std::string_view passes = "");

/// Appends a row for each run that has none, as soon as it is final, and for those that the search for the experiment's targets adds; a
/// run that fails is a row with the reason. Returns early, with the rows so far complete, when a stop was requested.
/// `replayed`: runs whose frame is only carried to the next one of their sequence.
void measure_picture(SweepContext& sweep, std::span<const Run> runs, std::span<const Run> replayed = {});

} // namespace ssrlab
