// store_ray.glsl in double precision.
#include "layout/packed_ray.glsl"
#include "layout/stored_texels.glsl"

uvec4 reals_to_texel(real a, real b) { return uvec4(unpackDouble2x32(a), unpackDouble2x32(b)); }

#define STORE_RAY(rays, index, ray)                                                                                                        \
    STORE_TEXEL(rays, (index) * 4, reals_to_texel((ray).origin.x, (ray).origin.y));                                                        \
    STORE_TEXEL(rays, (index) * 4 + 1, reals_to_texel((ray).origin.z, (ray).length_m));                                                    \
    STORE_TEXEL(rays, (index) * 4 + 2, reals_to_texel((ray).delta.x, (ray).delta.y));                                                      \
    STORE_TEXEL(rays, (index) * 4 + 3, uvec4(unpackDouble2x32((ray).delta.z), (ray).pixel, 0))
