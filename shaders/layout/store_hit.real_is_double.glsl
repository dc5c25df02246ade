// store_hit.glsl for the double twin.
#include "layout/stored_texels.glsl"

#define STORED_HITS STORED_TEXELS_4
uvec4 hit_to_texel(uint pixel, real t) { return uvec4(pixel, 0, unpackDouble2x32(t)); }
