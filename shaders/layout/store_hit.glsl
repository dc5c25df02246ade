// Stores what was found of a ray (layout/packed_hit.glsl). pixel: pack_pixel() of the pixel that was hit and of the status.
#include "layout/stored_texels.glsl"

#define STORED_HITS STORED_TEXELS_2
uvec2 hit_to_texel(uint pixel, real t) { return uvec2(pixel, floatBitsToUint(t)); }
