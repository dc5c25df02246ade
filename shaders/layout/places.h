// Where depths, cells and planes lie in memory, as C++ (through shared.h) and GLSL agree.

// The depth pyramid's rows are a binary heap: the picture's row y is row root + y, where the root is the power of two that covers the picture's
// height, and the cells above a row lie in the row of half its number. Level 0 holds two pixels in the place of a cell. All lies in strips of
// 2^STRIP_BITS cells' width: a row of one is a cache line, and what a ray meets on its way up or down the picture follows in memory.
#define STRIP_BITS 3

// With a row below the picture, which holds background as all beside it does; odd, so that the strips' cache lines do not compete for the same
// places.
SHARED_FUNCTION int pyramid_rows(int root, int height_px) { return (root + height_px + 1) | 1; }

SHARED_FUNCTION int strip_index(int x, int row, int rows)
{
    return (((x >> STRIP_BITS) * rows + row) << STRIP_BITS) + (x & ((1 << STRIP_BITS) - 1));
}

// Behind the cells lie two words a pixel: its depth, and its plane's gradient (core/plane_gradient.h), in strips of their own with a row of background
// below the picture. Models with planes read a pixel there, as they read a cell.
SHARED_FUNCTION int planes_first(int width_px, int rows) { return strip_index(((width_px - 1) >> (STRIP_BITS + 1)) << STRIP_BITS, rows, rows); }
SHARED_FUNCTION int planes_rows(int height_px) { return (height_px + 1) | 1; }
