// samples.csv: every timed frame, so that all times in results.csv can be recomputed.
#pragma once

#include "harness/csv.h"
#include "harness/measured_run.h"

#include <map>
#include <string>
#include <string_view>

namespace ssrlab {

/// Returns run_id, round, pass, ms, cpu_ms. A round is one turn of all open runs of a frame, in random order; runs of
/// one round are pairs. Rounds are numbered per frame; a resumed sweep continues with higher numbers.
const CsvRecord& sample_columns();

/// Returns a record for each pass of each timed frame, and one with pass = "frame": the sum, as in frame_ms_*, with
/// the program's processor time while the frame ran.
std::string samples_text(const MeasuredRun& measured);

/// The number of frames of each run in a samples.csv.
struct SampleCounts {
    std::map<std::string, int> frames; // by run id
    int                        next_round = 0;
};
/// Counts samples. `records`: the file without header; a torn last record is left out.
SampleCounts count_samples(std::string_view records);

} // namespace ssrlab
