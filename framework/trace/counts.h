// What the device counts of a G-buffer and of a trace.
#pragma once

#include "shared.h"

#include <array>
#include <cstdint>

namespace ssrlab {

/// shaders/rays/classification.comp counts these on the G-buffer.
struct GBufferCounts {
    uint32_t                             surface_pixels = 0, reflecting_pixels = 0, reflecting_tiles = 0;
    std::array<uint32_t, ROUGHNESS_BINS> roughness_pixels{}; // of reflecting pixels; bin 0: roughness 0
    bool                                 operator==(const GBufferCounts&) const = default;
};

/// shaders/trace/trace_statistics.comp counts these after tracing.
struct TraceCounts {
    uint32_t rays = 0, hits = 0, mirror_hits = 0; // mirror hits: the hit surface reflects, too
};

} // namespace ssrlab
