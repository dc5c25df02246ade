// sources.csv: one row for each source of each run's list: which rays it got, what it answered, how rightly, and at
// what price. docs/explanation/beyond.md defines the measures.
#pragma once

#include "harness/choose_sources.h"
#include "harness/measured_run.h"
#include "truth/scene_truth.h"

#include <map>
#include <string>
#include <string_view>

namespace ssrlab {

/// Returns the columns of one source, from its place in the list on. A file has others before them that say what was
/// asked.
std::span<const Column> source_columns();
/// Returns the columns of sources.csv: run_id and source_columns().
std::span<const Column> source_file_columns();

/// Returns the context of the shown frame, with the cameras of the frames before it. Throws Failure for a frame file.
SourceContext context_of_frame(Stage& stage, const Technique& technique, const ParameterValues& values,
                               const FrameSettings& settings, const std::string& view, SequenceFrame at);

/// Asks the sources of a list and returns the values of source_columns(), a record per source. Its times are medians of
/// three more turns: in the first one, a driver may compile pipelines.
std::vector<Record> ask_sources(SourceContext& context, const ChosenSources& sources, HandOn hand_on,
                                const SceneTruth& truth);

/// Adds the measures of a list to the row of its run, from the records of ask_sources().
void add_sources(Record& row, std::span<const Record> sources);

/// Returns the run's lines of sources.csv.
std::string sources_text(const MeasuredRun& measured);

/// Returns the number of rows by run id. `records`: the file without header; a torn last one is left out.
std::map<std::string, int64_t> count_sources(std::string_view records);

} // namespace ssrlab
