// Writes a pixel: its depth for passes, and its depth with its plane for techniques.
#include "layout/depth_words.glsl"
#include "layout/plane_places.glsl"
#include "layout/float_texels.glsl"
#include "layout/stored_texels.glsl"

STORED_FLOATS(DEPTH_BINDING, depth_words)
STORED_TEXELS_2(PLANES_BINDING, StoredPlanes)

// gradient: two packed halves, see unpack_gradient() (framework/core/plane_gradient.h).
void store_depth(ivec2 pixel, float depth, uint gradient)
{
    STORE_FLOAT(depth_words, depth_word(pixel), depth);
    STORE_TEXEL(StoredPlanes, plane_index(pixel), uvec2(floatBitsToUint(depth), gradient));
}
