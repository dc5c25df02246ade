// One run under measurement: its pipelines, its timings so far, its row so far.
#pragma once

#include "compare/measures.h"
#include "harness/experiment.h"
#include "harness/record.h"

#include <map>
#include <vector>

namespace ssrlab {

struct MeasuredRun {
    const Run*                                 run = nullptr;
    LabPtr                                     lab;
    FramePlan                                  plan;
    FramePtr                                   frame, unculled; // the same without skipping, or null
    Record                                     row;
    std::vector<int>                           rounds; // one entry per timed frame, as in the lists below
    std::vector<double>                        trace_ms, frame_ms, cpu_ms, saved_ms;
    std::map<std::string, std::vector<double>> pass_ms;               // by pass, of those that ran
    std::vector<std::string>                   structures;            // of the technique
    int                                        repeats           = 0; // that it will have, known before the first one
    int                                        frames_per_submit = 1;
};

/// Run id, experiment, scene … and every setting and parameter.
Record identity_row(const Experiment& experiment, const Run& run, const Technique& technique);
/// Rays, fetches, steps and how the rays ended, from a counted trace; outcome ok or no_rays.
void add_counts(Record& row, const TraceResult& counted);
/// The measures that have a column.
void add_measures(Record& row, const MeasureValues& values);
/// Pairs of a planned and an unculled frame.
inline constexpr int saved_pairs = 5;
/// How many frames a submit has, of which the last is timed: on a GPU as many as fill 5 ms, since one that has just been idle is slower.
int frames_for(double frame_ms, const MeasureSettings& measure, const GpuInfo& device);
/// One timed frame, and the first few times the unculled one, too.
void add_repeat(Gpu& gpu, MeasuredRun& measured, double gbuffer_ms, int round);
/// How many repeats fit into the budget, from the wall time of a frame before the first repeat. Their number depends on no time
/// that is recorded: stopping where an interval happens to be tight would make intervals too tight.
int  repeats_for(double pilot_s, const MeasureSettings& measure);
void add_times(MeasuredRun& measured, double gbuffer_ms);
/// Outcome failed or, of an InvalidResult, invalid; and why.
Record failed_row(Record row, const std::exception& error);

/// The command that shows what each ray of a run found.
std::string trace_command(const Experiment& experiment, const Run& run, const Technique& technique);

} // namespace ssrlab
