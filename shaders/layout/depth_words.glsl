// The depth of a pixel, as one word.
#include "layout/numbers.h"
#include "layout/cell_index.glsl"

#ifndef DEPTH_BINDING
#define DEPTH_BINDING 1
#endif

int depth_word(ivec2 pixel) { return 2 * cell_index(pixel, 0) + (pixel.x & 1); }
