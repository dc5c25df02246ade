// Depth as other renderers store it, and what is left of it after its import.
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

/// What becomes of depth near_m / distance_m when it is stored and imported. far_m: of formats with a finite far plane.
float stored_and_imported(const DepthFormat& format, float depth, double near_m, double far_m);

/// The setup of a perspective view with its depth stored and imported; the far plane at 1.5 times the farthest surface.
Setup stored_and_imported(Setup setup, const DepthFormat& format);

} // namespace ssrlab
