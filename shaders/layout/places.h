// Where depths, cells and planes lie in memory, as C++ (through shared.h) and GLSL agree.

// The rows of the depth pyramid form a binary heap. Row y of the image is row root + y, and the parent of a row has half its number. The root is
// the smallest power of two that covers the image's height. At level 0 two pixels take the place of a cell. Everything lies in strips that are
// 2^STRIP_BITS cells wide: one row of a strip is a cache line, and texels above and below each other are adjacent in memory.
#define STRIP_BITS 3

// Adds one background row below the image, and rounds up to an odd number, so that the strips do not compete for the same cache sets.
//
SHARED_FUNCTION int pyramid_rows(int root, int height_px) { return (root + height_px + 1) | 1; }

SHARED_FUNCTION int strip_index(int x, int row, int rows)
{
    return (((x >> STRIP_BITS) * rows + row) << STRIP_BITS) + (x & ((1 << STRIP_BITS) - 1));
}

// Behind the cells lie two words for each pixel: its depth and its plane's gradient. They have strips of their own, with one background row below
// the image. Surface models with planes read a pixel there in the way that they read a cell.
SHARED_FUNCTION int planes_first(int width_px, int rows) { return strip_index(((width_px - 1) >> (STRIP_BITS + 1)) << STRIP_BITS, rows, rows); }
SHARED_FUNCTION int planes_rows(int height_px) { return (height_px + 1) | 1; }
