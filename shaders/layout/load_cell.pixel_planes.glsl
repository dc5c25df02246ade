// load_cell.glsl where pixels have planes: at level 0 the pixel's depth and gradient.
#include "layout/plane_places.glsl"
#include "layout/texels.glsl"

LOADED_TEXELS_2(3, depth_cells)

// plane_index() at level 0, cell_index() above, with one multiplication.
uvec2 load_cell(ivec2 pixel, int level)
{
    bool leaf  = level == 0;
    int  index = strip_index(pixel.x >> level, (pyramid_root | pixel.y) >> level, leaf ? leaf_rows : pyramid_height) + (leaf ? leaf_first : 0);
    return LOAD_TEXEL(depth_cells, index).xy;
}

float depth_in(uvec2 words, ivec2 pixel) { return uintBitsToFloat(words.x); }
