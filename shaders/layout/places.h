// Where depths, cells and planes lie in memory, as C++ (through shared.h) and GLSL agree.

// The pyramid's rows form a binary heap. Row y of the image is row root + y, and a row's parent has half its number;
// the root is the least power of two that covers the image's height. At level 0 two pixels take the place of a cell.
// Strips are 2^STRIP_BITS cells wide: a row of one is a cache line, and texels above each other are adjacent in memory.
#define STRIP_BITS 3

// With one background row below the image, rounded up to odd, so that strips do not compete for the same cache sets.
//
SHARED_FUNCTION int pyramid_rows(int root, int height_px) { return (root + height_px + 1) | 1; }

SHARED_FUNCTION int strip_index(int x, int row, int rows)
{
    return (((x >> STRIP_BITS) * rows + row) << STRIP_BITS) + (x & ((1 << STRIP_BITS) - 1));
}

// Behind the cells lie two words for each pixel, its depth and its plane's gradient, in strips of their own with one
// background row below the image. Surface models with planes read a pixel there as they read a cell.
SHARED_FUNCTION int planes_first(int width_px, int rows) { return strip_index(((width_px - 1) >> (STRIP_BITS + 1)) << STRIP_BITS, rows, rows); }
SHARED_FUNCTION int planes_rows(int height_px) { return (height_px + 1) | 1; }
