// What tracing found of a ray of the list, in a texel (layout/packed_ray.glsl says why).
#include "api/real.glsl"
#include "layout/texels.glsl"

struct PackedHit
{
    uint pixel; // pack_pixel() of the pixel that was hit and of the status
    real t;
};

#define LOADED_HITS LOADED_TEXELS_2
PackedHit texel_to_hit(uvec4 texel) { return PackedHit(texel.x, uintBitsToFloat(texel.y)); }
