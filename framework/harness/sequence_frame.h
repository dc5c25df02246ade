// What only a frame among others of a sequence needs: its history, its measures, and frames that are replayed. Folder-internal.
#pragma once

#include "harness/picture.h"

namespace ssrlab {

/// What the run's frame before left; null where frames do not follow each other. Throws Failure where that frame failed.
FrameHistoryPtr history_of(SweepContext& sweep, const Run& run);

/// The run's next frame finds what this one leaves. Runs share images, so this one runs once more.
void leave_history(SweepContext& sweep, const Run& run, ReadyFrame& frame);

/// Adds the measures that need the frames before, and remembers this one.
void judge_sequence(SweepContext& sweep, Picture& picture, MeasuredRun& measured, const Observed& observed);

/// After a frame that failed: what follows does not follow from it.
void lose_sequence(SweepContext& sweep, const Run& run);

/// Carries a run to its next frame, without a row.
void replay(SweepContext& sweep, const Picture& picture, const Run& run);

/// Makes SweepContext::converged for the settings of these runs, if nothing but jitter moves from their first frame to `last_frame`.
void make_converged_pictures(SweepContext& sweep, std::span<const Run> runs, int last_frame);

} // namespace ssrlab
