// layout/load_cell.glsl includes this where pixels have planes.
#include "layout/plane_places.glsl"

int leaf_rows = planes_rows(size_px.y), leaf_first = planes_first(size_px.x, pyramid_height) - (pyramid_root << STRIP_BITS);

// plane_index() at level 0, cell_index() above, with one multiplication.
uvec2 load_cell(ivec2 pixel, int level)
{
    bool leaf  = level == 0;
    int  index = strip_index(pixel.x >> level, (pyramid_root | pixel.y) >> level, leaf ? leaf_rows : pyramid_height) + (leaf ? leaf_first : 0);
    return LOAD_TEXEL(depth_cells, index).xy;
}

// What load_cell() says of this pixel at level 0.
float depth_in(uvec2 words, ivec2 pixel) { return uintBitsToFloat(words.x); }
