// Writes one cell, for structures. 
#include "layout/cell_places.glsl"
#include "layout/stored_texels.glsl"

STORED_TEXELS_2(12, StoredCell)

void store_cell(ivec2 cell, int level, uvec2 words) { STORE_TEXEL(StoredCell, strip_index(cell.x, (pyramid_root >> level) + cell.y, pyramid_height), words); }
