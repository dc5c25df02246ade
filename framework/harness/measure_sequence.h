// All runs on one scene, view and size, frame by frame.
#pragma once

#include "harness/measure_picture.h"

namespace ssrlab {

/// Like measure_picture(), for each frame in the order of time. A run finds what it left in the frame before. Frames that have their
/// rows, or that the specification does not list, are replayed without a row, where a later one follows from them. At the end of a
/// sequence its summary is written.
void measure_sequence(SweepContext& sweep, std::span<const Run> runs);

} // namespace ssrlab
