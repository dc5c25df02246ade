// The gradients of four pixels in a row, x a multiple of four. After layout/cell_pairs.glsl.
#include "layout/plane_places.glsl"

uvec4 load_gradients(ivec2 pixel)
{
    int first = plane_index(pixel) >> 1;
    return uvec4(load_pair(first).yw, load_pair(first + 1).yw);
}
