// What only a frame that follows another one needs: its history, its measures, and frames that are replayed. Folder-internal.
#pragma once

#include "harness/picture.h"

namespace ssrlab {

/// What the frame before left; null for a single frame.
FrameHistoryPtr history_of(Bench& bench, const Run& run);
/// The next frame finds what this one leaves. Runs share images, so it is run once more.
void leave_history(Bench& bench, const Run& run, PreparedFrame& frame);
/// After a frame that failed: what follows does not follow from it.
void lose_history(Bench& bench, const Run& run);

/// Adds the measures that need the frames before, and remembers this one.
void judge_sequence(Bench& bench, Picture& picture, MeasuredRun& measured, const Observed& observed);

/// Carries a run to its next frame, without a row.
void replay(Bench& bench, const Picture& picture, const Run& run);

/// Makes Bench::converged for the settings of these runs of one frame, if their view is still and jittered.
void make_converged_pictures(Bench& bench, std::span<const Run> runs);

} // namespace ssrlab
