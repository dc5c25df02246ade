// Where the planes of pixels lie: behind the cells.
#include "layout/cell_places.glsl"

int leaf_rows = planes_rows(size_px.y), leaf_first = planes_first(size_px.x, pyramid_height) - (pyramid_root << STRIP_BITS);

// Of the two words of a pixel with its plane.
int plane_index(ivec2 pixel) { return strip_index(pixel.x, pyramid_root + pixel.y, leaf_rows) + leaf_first; }
