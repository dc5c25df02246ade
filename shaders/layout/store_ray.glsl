// Stores a ray of a list (layout/packed_ray.glsl).
#include "layout/packed_ray.glsl"
#include "layout/stored_texels.glsl"

#define STORE_RAY(rays, index, ray)                                                                                                        \
    STORE_TEXEL(rays, (index) * 2, floatBitsToUint(vec4((ray).origin, (ray).length_m)));                                                   \
    STORE_TEXEL(rays, (index) * 2 + 1, uvec4(floatBitsToUint((ray).delta), (ray).pixel))
