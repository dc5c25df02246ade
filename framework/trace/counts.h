// Counts of a G-buffer and of a trace, made on the device.
#pragma once

#include "shared.h"

#include <array>
#include <cstdint>

namespace ssrlab {

/// Counts of a G-buffer (shaders/rays/classification.comp).
struct GBufferCounts {
    uint32_t                             surface_pixels = 0, reflecting_pixels = 0, reflecting_tiles = 0;
    std::array<uint32_t, ROUGHNESS_BINS> roughness_pixels{}; // of reflecting pixels; bin 0: roughness 0
    bool                                 operator==(const GBufferCounts&) const = default;
};

/// Counts of a trace (shaders/trace/trace_statistics.comp).
struct TraceCounts {
    uint32_t rays = 0, hits = 0, mirror_hits = 0; // mirror hits: the hit surface reflects, too
};

} // namespace ssrlab
