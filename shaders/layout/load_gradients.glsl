// layout/cell_pairs.glsl includes this where pixels have planes.
#include "layout/plane_places.glsl"

// The gradients of four pixels in a row, x a multiple of four.
uvec4 load_gradients(ivec2 pixel)
{
    int first = plane_index(pixel) >> 1;
    return uvec4(load_pair(first).yw, load_pair(first + 1).yw);
}
