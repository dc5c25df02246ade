// slab_front.glsl where a slab reaches as far before its depth as behind it. Numbers as api/slab.glsl has them for the back.
#include "layout/frame_shared.h"
#include "api/slab_real.glsl"
layout(constant_id = CONSTANT_FRONT_SLOPE) const slab_real front_slope = 0;
layout(constant_id = CONSTANT_FRONT_SCALE) const slab_real front_scale = 1;
layout(constant_id = CONSTANT_FRONT_SHIFT) const slab_real front_shift = 0;
const slab_real infinitely_near = slab_real(1e30);

slab_real slab_front_of(slab_real depth)
{
    slab_real         below = slab_real(1) + depth * front_slope;
    precise slab_real front = (depth * front_scale - front_shift) / below;
    return below > slab_real(0) ? front : infinitely_near;
}
real slab_front(real depth) { return real(slab_front_of(slab_real(depth))); }
