// packed_ray.glsl in double precision: four texels a ray.
#include "api/real.glsl"
#include "layout/texels.glsl"

struct PackedRay
{
    real3 origin;
    real  length_m;
    real3 delta;
    uint  pixel; // pack_pixel() of the pixel and of the status of a miss
};

real2 texel_to_reals(uvec4 texel) { return real2(packDouble2x32(texel.xy), packDouble2x32(texel.zw)); }

PackedRay texels_to_ray(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    real2 first = texel_to_reals(a), second = texel_to_reals(b), third = texel_to_reals(c);
    return PackedRay(real3(first, second.x), second.y, real3(third, packDouble2x32(d.xy)), d.z);
}

#define LOAD_RAY(rays, index)                                                                                                              \
    texels_to_ray(LOAD_TEXEL(rays, (index) * 4), LOAD_TEXEL(rays, (index) * 4 + 1), LOAD_TEXEL(rays, (index) * 4 + 2),               \
                  LOAD_TEXEL(rays, (index) * 4 + 3))
#define LOAD_RAY_PIXEL(rays, index) LOAD_TEXEL(rays, (index) * 4 + 3).z
