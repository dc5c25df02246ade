// What only a frame among others of a sequence needs: its measures, and frames that are replayed. Folder-internal.
#pragma once

#include "harness/picture.h"

namespace ssrlab {

/// Adds the measures that need the frame before, and remembers this one.
void judge_sequence(Bench& bench, Picture& picture, MeasuredRun& measured, const Observed& observed);

/// After a frame that failed: what follows does not follow from it.
void lose_sequence(Bench& bench, const Run& run);

/// Remembers a run's frame for its next one, without a row.
void replay(Bench& bench, const Picture& picture, const Run& run);

} // namespace ssrlab
