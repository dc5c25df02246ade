// What tracing found of a ray of the list, in a texel (layout/packed_ray.glsl says why).
#ifndef SSRLAB_PACKED_HIT
#define SSRLAB_PACKED_HIT
#include "api/real.glsl"
#include "layout/texels.glsl"

struct PackedHit
{
    uint pixel; // pack_pixel() of the pixel that was hit and of the status
    real t;
};

#ifdef REAL_IS_DOUBLE
#include "layout/packed_hit_double.glsl"
#else
#define LOADED_HITS LOADED_TEXELS_2
#define STORED_HITS STORED_TEXELS_2
uvec2 hit_to_texel(PackedHit hit) { return uvec2(hit.pixel, floatBitsToUint(hit.t)); }
PackedHit texel_to_hit(uvec4 texel) { return PackedHit(texel.x, uintBitsToFloat(texel.y)); }
#endif
#endif
