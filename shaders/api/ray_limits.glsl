// Where the run lets rays begin and end.
#ifndef SSRLAB_RAY_LIMITS
#define SSRLAB_RAY_LIMITS
#include "api/real.glsl"
#include "layout/shared.h"

layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1;
layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0;
#endif
