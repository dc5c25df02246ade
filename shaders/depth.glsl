// The depth of every pixel, BACKGROUND_DEPTH where there is nothing: level 0 of the depth pyramid (framework/render/depth_pyramid.h); and where its
// cells lie. After size_px.
#include "shared.h"
#ifndef DEPTH_BINDING
#define DEPTH_BINDING 1
#endif
#ifdef WRITES_DEPTH
#define DEPTH_ACCESS writeonly
#else
#define DEPTH_ACCESS readonly
#endif
layout(set = 0, binding = DEPTH_BINDING, r32f) uniform DEPTH_ACCESS imageBuffer depth_words;

// Levels above 0: 2^levels covers the larger side of the image.
int pyramid_levels()
{
    int side = max(size_px.x, size_px.y);
    return side > 1 ? findMSB(side - 1) + 1 : 0;
}

// Where a cell lies, or at level 0 the two pixels of which this is one.
int cell_index(ivec2 cell, int level)
{
    return strip_index(mix(cell.x, cell.x >> 1, level == 0), level_row(size_px.y, level) + cell.y, pyramid_rows(size_px.y));
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
