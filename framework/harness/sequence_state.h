// The state of a run between the frames of a sequence, and the summary of all its frames.
#pragma once

#include "compare/measures.h"
#include "frame/frame_history.h"
#include "harness/columns.h"
#include "harness/result_folder.h"

#include <span>

namespace ssrlab {

/// State of one technique with one set of values and settings, from frame to frame.
struct SequenceState {
    FrameHistoryPtr          history; // of the last frame
    std::optional<HitPlaces> places;  // likewise
    Flips                    flips;
    TemporalMoments          moments;
    int                      pictures = 0;
    bool                     moved    = false; // something besides jitter moved, in some frame
    bool                     failed   = false; // a frame failed, so later ones have no history
};

/// Returns whether frames have a history and sequences a summary. A search for targets looks at each frame alone.
bool is_sequence(const Experiment& experiment);

/// Returns the short hash of a run without its frame.
std::string sequence_id(const Run& run);

/// Adds a frame, in the order of time. Returns flip_share if the frame can be compared with the one before.
MeasureValues watch(SequenceState& state, const Image& shaded, const TraceImage& traced, glm::dvec2 jitter_px,
                    bool moved);

/// Returns the columns of sequence_summary.csv.
std::vector<Column> summary_columns(const Experiment& experiment, std::span<const Technique> techniques);

/// Returns the summary of a sequence from the rows of its frames, in the order of time.
Record summary_row(const Record& identity, std::span<const Record> frames, const SequenceState& state);

/// Returns the ids of the sequences that have a summary in the folder.
std::set<std::string> summarised(const std::filesystem::path& folder);
/// Adds a summary or replaces that of the same sequence; writes the file as a whole.
void write_summary(const std::filesystem::path& folder, std::span<const Column> columns, const Record& row);

} // namespace ssrlab
