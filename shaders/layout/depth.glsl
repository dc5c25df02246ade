// The depth of every pixel, BACKGROUND_DEPTH where there is nothing: level 0 of the depth pyramid (framework/render/depth_pyramid.h); and where its
// cells lie. After size_px.
#include "layout/shared.h"
#ifndef DEPTH_BINDING
#define DEPTH_BINDING 1
#endif
#ifdef WRITES_DEPTH
#define DEPTH_ACCESS writeonly
#else
#define DEPTH_ACCESS readonly
#endif
layout(set = 0, binding = DEPTH_BINDING, r32f) uniform DEPTH_ACCESS imageBuffer depth_words;

// Levels above 0: until one row of cells is left.
int pyramid_levels()
{
    return findMSB(2 * size_px.y - 1);
}

int pyramid_root = 1 << pyramid_levels(), pyramid_height = pyramid_rows(pyramid_root, size_px.y);

int cell_index(ivec2 pixel, int level)
{
    return pixel_to_cell_index(pixel.x, pixel.y, level, pyramid_root, pyramid_height);
}

int depth_word(ivec2 pixel)
{
    return 2 * cell_index(pixel, 0) + (pixel.x & 1);
}

#ifndef WRITES_DEPTH
float load_depth(ivec2 pixel)
{
    return imageLoad(depth_words, depth_word(pixel)).x;
}
#endif
