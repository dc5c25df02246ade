// Depth as other renderers store it, and what their precision leaves after import.
#pragma once

#include "check/setup.h"

namespace ssrlab {

struct DepthFormat {
    std::string name;
    int         bits     = 32;    // 32: float, else unsigned normalised
    bool        reversed = true;  // 1 at the near plane; else 0 there
    bool        infinite = false; // no far plane
};
const std::vector<DepthFormat>& depth_formats();

/// Returns depth near_m / distance_m after storing and importing. far_m: for finite formats.
float stored_and_imported(const DepthFormat& format, float depth, double near_m, double far_m);

/// Returns a perspective setup with its depth stored and imported; far plane at 1.5 times the farthest surface.
Setup stored_and_imported(Setup setup, const DepthFormat& format);

} // namespace ssrlab
