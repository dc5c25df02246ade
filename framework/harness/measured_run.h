// A run under measurement: its pipelines, timings and row so far.
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
    FramePtr                                   frame, unculled; // `unculled`: with no pass skipped, or null
    Record                                     row;
    std::vector<int>                           rounds; // one entry per timed frame, as in the lists below
    std::vector<double>                        trace_ms, frame_ms, cpu_ms, saved_ms;
    std::map<std::string, std::vector<double>> pass_ms;               // by pass, of those that ran
    std::map<std::string, PassTraffic>         traffic;               // likewise
    std::vector<std::string>                   structures;            // of the technique
    std::vector<Record>                        sources;               // of its list: ask_sources(), source_rows.h
    int                                        repeats           = 0; // in total, known before the first one
    int                                        frames_per_submit = 1;
};

/// Returns a row with run id, experiment, scene … and every setting and parameter.
Record identity_row(const Experiment& experiment, const Run& run, const Technique& technique);
/// Adds rays, fetches, steps and how the rays ended, from a counted trace; sets the outcome ok or no_rays.
void add_counts(Record& row, const TraceImage& counted);
/// Adds the measures that have a column.
void add_measures(Record& row, const MeasureValues& values);
/// Pairs of a planned and an unculled frame.
inline constexpr int saved_pairs = 5;
/// Returns the number of frames per submit: on a GPU as many as fill 5 ms, since an idle one is slower at first.
int frames_for(double frame_ms, const MeasureSettings& measure, const GpuInfo& device);
/// Times one frame and, in the first saved_pairs repeats, the unculled one.
void add_repeat(Gpu& gpu, MeasuredRun& measured, double gbuffer_ms, int round);
/// Returns how many repeats fit into the budget, given the wall time of an untimed frame. The number depends on no
/// recorded time: stopping when a confidence interval happens to be tight would make intervals too tight.
int  repeats_for(double pilot_s, const MeasureSettings& measure);
void add_times(MeasuredRun& measured, double gbuffer_ms);
/// Sets the outcome to failed, or invalid for an InvalidResult, and the message.
Record failed_row(Record row, const std::exception& error);

/// Returns the command that writes what each ray of a run found.
std::string trace_command(const Experiment& experiment, const Run& run, const Technique& technique);

} // namespace ssrlab
