// What a pyramid walk would cost if its cells knew everything: the bound of better cells, if not of a better start.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"

namespace ssrlab {

/// Cells visited per ray by hiz's own walk (start at level 0, climb one level where the parent changes) if a cell
/// answered "touched" exactly when the ray's hit lies in it.
double visits_with_perfect_cells(const GBufferImage& gbuffer, const TraceSettings& settings, const TraceImage& truth,
                                 int top_level);

} // namespace ssrlab
