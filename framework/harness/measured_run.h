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
    PreparedFramePtr                           frame, everything; // the same with everything on, or null
    Row                                        row;
    std::vector<double>                        trace_ms, frame_ms, saved_ms;
    std::map<std::string, std::vector<double>> effect_ms;   // by effect, of those that ran
    double                                     spent_s = 0; // wall time of the timed frames
};

/// Run id, experiment, scene … and every setting and parameter.
Row identity_row(const Experiment& experiment, const Run& run, const Technique& technique);
/// Rays, fetches, steps and how the rays ended, from a counted trace; outcome ok or no_rays.
void add_counts(Row& row, const TraceResult& counted);
/// The measures that have a column.
void add_measures(Row& row, const MeasureValues& values);
/// Which effects were skipped.
void add_plan(Row& row, const std::vector<PlannedEffect>& plan);
/// Pairs of a planned frame and one with everything on.
inline constexpr int saved_pairs = 5;
/// One timed frame, and the first few times one with everything on.
void add_repeat(Gpu& gpu, MeasuredRun& measured, double gbuffer_ms);
/// Enough repeats, and the interval is tight or the budget spent.
bool is_final(const MeasuredRun& measured, const MeasureSettings& measure);
void add_times(MeasuredRun& measured, double gbuffer_ms);
/// Outcome failed or, of an InvalidResult, invalid; and why.
Row failed_row(Row row, const std::exception& error);

/// The most loop iterations of one ray that a technique declares, or that any may take.
double declared_steps(const Technique& technique, const ParameterValues& values);

/// The command that shows what each ray of a run found.
std::string trace_command(const Run& run, const Technique& technique);

/// Six significant digits; NaN is an empty field.
std::string number_text(double value);

} // namespace ssrlab
