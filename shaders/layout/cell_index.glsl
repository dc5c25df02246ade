// The places of cells and of pixels without planes.
#include "layout/cell_places.glsl"
#include "layout/cell_index.h"

// Of the cell of a level that holds a pixel, or at level 0 of the two pixels of which it is one.
int cell_index(ivec2 pixel, int level) { return pixel_to_cell_index(pixel.x, pixel.y, level, pyramid_root, pyramid_height); }
