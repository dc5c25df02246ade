// What a frame of a sequence needs besides: history, measures, and replayed frames. Folder-internal.
#pragma once

#include "harness/picture.h"

namespace ssrlab {

/// Returns the history of the run's frame before; null for single frames. Throws Failure if that frame failed.
FrameHistoryPtr history_of(SweepContext& sweep, const Run& run);

/// Keeps the frame's history for the next one. Runs share images, so the frame runs once more.
void leave_history(SweepContext& sweep, const Run& run, ReadyFrame& frame);

/// Adds the measures that compare with earlier frames, and remembers this one.
void judge_sequence(SweepContext& sweep, MeasuredPicture& picture, MeasuredRun& measured, const Observed& observed);

/// Marks the run's sequence as failed, after a frame that failed.
void lose_sequence(SweepContext& sweep, const Run& run);

/// Runs a frame only for the history of the next one, without a row.
void replay(SweepContext& sweep, const MeasuredPicture& picture, const Run& run);

/// Makes SweepContext::converged for the settings of these runs, if only jitter moves up to `last_frame`.
void make_converged_pictures(SweepContext& sweep, std::span<const Run> runs, int last_frame);

} // namespace ssrlab
