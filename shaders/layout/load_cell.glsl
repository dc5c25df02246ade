// Reads pixels and cells, for techniques. Pixels and cells are read alike, since the lanes of a group stand on different levels.
#include "layout/cell_index.glsl"
#include "layout/texels.glsl"

LOADED_TEXELS_2(3, depth_cells)

// The two words of the cell of a level that holds a pixel. At level 0 the depths of two pixels, or with planes the pixel's depth and gradient.
uvec2 load_cell(ivec2 pixel, int level) { return LOAD_TEXEL(depth_cells, cell_index(pixel, level)).xy; }

// What load_cell() says of this pixel at level 0.
float depth_in(uvec2 words, ivec2 pixel) { return uintBitsToFloat((pixel.x & 1) != 0 ? words.y : words.x); }
