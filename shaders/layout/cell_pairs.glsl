// Reads and writes two cells at once, for structures.
#include "layout/cell_places.glsl"
#include "layout/texels.glsl"
#include "layout/stored_texels.glsl"

LOADED_TEXELS_4(10, cell_pairs)
STORED_TEXELS_4(11, StoredCells)

// Two cells side by side, or four pixels. x: even (a multiple of four for pixels). first_row: the row of the heap with which the cells' level begins.
int pair_index(ivec2 cell, int first_row) { return strip_index(cell.x, first_row + cell.y, pyramid_height) >> 1; }

uvec4 load_pair(int index) { return LOAD_TEXEL(cell_pairs, index); }

void store_pair(int index, uvec4 cells) { STORE_TEXEL(StoredCells, index, cells); }
