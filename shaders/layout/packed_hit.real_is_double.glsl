// packed_hit.glsl for the double twin.
#include "api/real.glsl"
#include "layout/texels.glsl"

struct PackedHit
{
    uint pixel;
    real t;
};

#define LOADED_HITS LOADED_TEXELS_4
PackedHit texel_to_hit(uvec4 texel) { return PackedHit(texel.x, packDouble2x32(texel.zw)); }
