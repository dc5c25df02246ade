// An environment map as rough surfaces reflect it: the first half of the split sum (Karis 2013, Unreal Engine 4).
//
// Level k of n holds, for each mirror direction, the mean of the map over the GGX lobe of roughness ((k + 1) / n)^1.5
// seen along the normal, by its BRDF's weights. It sums all texels of a smaller map, so it has no noise; rougher
// levels sum coarser maps. shaders/passes/environment_lobe.glsl looks it up.
#pragma once

#include "scene/environment.h"

namespace ssrlab {

inline constexpr glm::ivec2 environment_level_px{256, 128};
inline constexpr int        environment_levels = 6;

double environment_level_roughness(int level);

/// All levels, one below the other; `map` must not be empty.
EnvironmentMap prefilter_environment(const EnvironmentMap& map);

} // namespace ssrlab
