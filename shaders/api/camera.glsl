// The image and the camera of the G-buffer (core/view.h).
#include "api/real.glsl"
#include "layout/numbers.h"

layout(constant_id = CONSTANT_ORTHOGRAPHIC) const int orthographic = 0; // 1: orthographic, 0: perspective
layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1; // where rays end

layout(set = 0, binding = 0, scalar) uniform View
{
    ivec2 size_px;   // first: it lies in the same place whether the rest is float or double
    real2 focal_px;  // perspective: pixels per unit of slope; orthographic: pixels per metre
    real2 centre_px; // where the view axis meets the image
    real2 focal_low_px, centre_low_px; // what rounding took from the two
    real  near_m;
    real  far_m; // orthographic only
};
