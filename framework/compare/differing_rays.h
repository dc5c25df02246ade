// Do two results say the same of the same rays?
#pragma once

#include "core/trace_image.h"

namespace ssrlab {

/// Returns whether two results differ at a ray: in its status or, where it ended at a pixel, in that pixel, the layer,
/// or t by more than `t_tolerance`.
bool differs_at(const TraceImage& a, const TraceImage& b, size_t ray, double t_tolerance = 0);

/// Returns the number of such rays.
size_t count_differing_rays(const TraceImage& a, const TraceImage& b, double t_tolerance = 0);

} // namespace ssrlab
