// What a run leaves from one frame of a sequence to the next, and the summary of all its frames.
#pragma once

#include "compare/measures.h"
#include "frame/frame_history.h"
#include "harness/columns.h"
#include "harness/result_folder.h"

#include <span>

namespace ssrlab {

/// Of one technique with one set of values and settings, while the frames of a sequence follow each other.
struct SequenceState {
    FrameHistoryPtr          history; // what the last frame left
    std::optional<HitPlaces> places;  // of the last frame
    Flips                    flips;
    TemporalMoments          moments;
    int                      pictures = 0;
    bool                     moved    = false; // something but jitter did, in some frame
    bool                     failed   = false; // in some frame: what comes after it does not follow from it
};

/// Whether frames follow each other: each has a history, and every sequence a summary. A search for targets looks at each frame alone.
bool is_sequence(const Experiment& experiment);

/// The short hash of a run without its frame.
std::string sequence_id(const Run& run);

/// Adds a frame, in the order of time. Returns flip_share, if the frame can be compared with the one before.
MeasureValues watch(SequenceState& state, const Image& shaded, const TraceResult& traced, glm::dvec2 jitter_px,
                    bool moved);

/// The columns of sequence_summary.csv.
std::vector<Column> summary_columns(const Experiment& experiment, std::span<const Technique> techniques);

/// The summary of a sequence from the rows of its frames, in the order of time.
Record summary_row(const Record& identity, std::span<const Record> frames, const SequenceState& state);

/// Ids of the sequences that have a summary in the folder.
std::set<std::string> summarised(const std::filesystem::path& folder);
/// Adds a summary, or replaces the one of the same sequence; the file is written as a whole.
void write_summary(const std::filesystem::path& folder, std::span<const Column> columns, const Record& row);

} // namespace ssrlab
