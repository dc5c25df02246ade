// The places of cells and of pixels without planes.
#include "layout/cell_places.glsl"
#include "layout/cell_index.h"

// The same in the pyramid of this image.
int cell_index(ivec2 pixel, int level) { return pixel_to_cell_index(pixel.x, pixel.y, level, pyramid_root, pyramid_height); }
