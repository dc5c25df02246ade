// slab_constants.glsl where a slab has no end.
#include "api/slab_real.glsl"
const slab_real slab_slope = 0, slab_scale = 0, slab_shift = 0;
