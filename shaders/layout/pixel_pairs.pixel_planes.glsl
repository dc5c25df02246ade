// Two pixels side by side, x even: of each its depth and its gradient.
#include "layout/plane_places.glsl"

uvec4 load_pixel_pair(ivec2 pixel) { return load_pair(plane_index(pixel) >> 1); }
