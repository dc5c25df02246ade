#include "layout/frame_shared.h"

layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0; // how far along its direction a ray starts
