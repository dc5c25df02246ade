// A ray as the list of rays holds it, in texels of four words: lavapipe reads one with a load for each lane. A texel of one word costs it almost as
// much, a word of a storage buffer a dozen instructions for each lane (docs/explanation/performance.md).
#include "api/real.glsl"
#include "layout/texels.glsl"

struct PackedRay
{
    real3 origin;
    real  length_m;
    real3 delta;
    uint  pixel; // pack_pixel() of the pixel and of the status of a miss
};

PackedRay texels_to_ray(uvec4 start, uvec4 delta)
{
    vec4 origin = uintBitsToFloat(start);
    return PackedRay(origin.xyz, origin.w, uintBitsToFloat(delta.xyz), delta.w);
}

#define LOAD_RAY(rays, index) texels_to_ray(LOAD_TEXEL(rays, (index) * 2), LOAD_TEXEL(rays, (index) * 2 + 1))
#define LOAD_RAY_PIXEL(rays, index) LOAD_TEXEL(rays, (index) * 2 + 1).w
