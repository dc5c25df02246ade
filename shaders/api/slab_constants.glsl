// The three numbers of api/slab.glsl.
#include "api/slab_real.glsl"
layout(constant_id = CONSTANT_SLAB_SLOPE) const slab_real slab_slope = 0;
layout(constant_id = CONSTANT_SLAB_SCALE) const slab_real slab_scale = 1;
layout(constant_id = CONSTANT_SLAB_SHIFT) const slab_real slab_shift = 0;
