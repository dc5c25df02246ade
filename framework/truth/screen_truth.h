// Screen truth: the hit contract evaluated in double precision on the CPU, every pixel that the ray crosses.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_result.h"

namespace ssrlab {

/// Independent of every shader. threads = 0: all cores. steps counts the pixels visited.
TraceResult screen_truth(const GBufferImage& gbuffer, const TraceSettings& settings, unsigned threads = 0);

} // namespace ssrlab
