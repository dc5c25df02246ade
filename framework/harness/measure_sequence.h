// All runs on one scene, view and size, frame by frame.
#pragma once

#include "harness/measure_picture.h"

namespace ssrlab {

/// Like measure_picture(), for each frame in the order of time; a run finds its history of the frame before. Frames
/// that have rows, or that the specification does not list, are replayed without a row if a later frame depends on
/// them. Writes a summary at the end of each sequence.
void measure_sequence(SweepContext& sweep, std::span<const Run> runs);

} // namespace ssrlab
