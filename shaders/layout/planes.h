// Where planes lie in memory, as C++ and GLSL agree. Included by both.
#ifndef SSRLAB_PLANES_H
#define SSRLAB_PLANES_H
#ifdef __cplusplus
#include "shared.h"
#else
#include "layout/shared.h"
#endif

// Behind the cells lie two words a pixel: its depth, and its plane's gradient (core/plane_gradient.h), in strips of their own with a row of background
// below the picture. Models with planes read a pixel there, as they read a cell.
SHARED_FUNCTION int planes_first(int width_px, int rows) { return strip_index(((width_px - 1) >> (STRIP_BITS + 1)) << STRIP_BITS, rows, rows); }
SHARED_FUNCTION int planes_rows(int height_px) { return (height_px + 1) | 1; }
SHARED_FUNCTION int planes_end(int width_px, int height_px, int first)
{
    return first + strip_index(((width_px - 1) >> STRIP_BITS) << STRIP_BITS, planes_rows(height_px), planes_rows(height_px));
}

#endif
