// The depth where a slab begins, which api/slab.glsl ends: the sample's own, or for a surface model that defines SURFACE_TWO_SIDED as far before
// it as the back lies behind it (slab_front.surface_two_sided.glsl).
#include "api/slab_real.glsl"

slab_real slab_front_of(slab_real depth) { return depth; }
real slab_front(real depth) { return real(slab_front_of(slab_real(depth))); }
