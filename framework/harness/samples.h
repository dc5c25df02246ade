// samples.csv: every timed frame, so that anyone can recompute what results.csv says of times.
#pragma once

#include "harness/csv.h"
#include "harness/measured_run.h"

#include <map>
#include <string>
#include <string_view>

namespace ssrlab {

/// run_id, round, pass, ms, cpu_ms. A round is one visit of all open runs of a frame (scene, view and size), in random
/// order; runs of one round are pairs. Rounds are numbered per frame; a resumed sweep goes on with higher numbers.
const CsvRecord& sample_columns();

/// One record for each pass of each timed frame, and one with pass = "frame": the sum that frame_ms_* summarises, with
/// the processor time of the program while the frame ran.
std::string samples_text(const MeasuredRun& measured);

/// What a samples.csv holds of each run.
struct SampleCounts {
    std::map<std::string, int> frames; // by run id
    int                        next_round = 0;
};
/// `records`: the file without its header. A torn last record is left out.
SampleCounts count_samples(std::string_view records);

} // namespace ssrlab
