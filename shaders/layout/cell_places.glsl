// Where the depth and the cells above it lie. One buffer holds the depth of every pixel, BACKGROUND_DEPTH where there is nothing, as level 0, and above
// it two words for each cell of each level, in strips one cache line wide, with rows as a binary heap (layout/places.h). A structure may fill the cells.
// After size_px, the image's size.
#include "layout/places.h"

// Levels above 0: until one row of cells is left.
int pyramid_levels() { return findMSB(2 * size_px.y - 1); }

int pyramid_root = 1 << pyramid_levels(), pyramid_height = pyramid_rows(pyramid_root, size_px.y);
