// What a cell of the depth pyramid knows, in two words:
//   x = code of the nearest front << 16 | code of the farthest slab back of its pixels
//   y = 32 bins of depth between the two, set where any of its pixels' slabs lies
// A depth code is the top of the number's own bits: monotone, exact to 2^-11, no logarithm needed. A bin is 2^bin_shift codes, as narrow as
// 32 bins allow, and begins at a multiple of its width: so the bins of a wider cell are unions of those of its quarters.
#include "shared.h"

const uvec2 empty_cell = uvec2(PYRAMID_MAX_CODE, 0); // nearest 0, farthest beyond everything, no bin

// Monotone in depth; depths below 2^-31, zero and negative numbers are all 0. NaN does not occur.
int depth_code(float depth)
{
    return max((floatBitsToInt(depth) >> 12) - (PYRAMID_LOWEST_EXPONENT << 11), 0);
}

int cell_nearest(uvec2 cell)
{
    return int(cell.x >> 16);
}

int cell_farthest(uvec2 cell)
{
    return int(cell.x & PYRAMID_MAX_CODE);
}

// The smallest shift for which (nearest >> shift) - (farthest >> shift) <= 31.
int bin_shift(int nearest, int farthest)
{
    // floor(log2(span)) from the float's exponent.
    int shift = max((floatBitsToInt(float(abs(nearest - farthest))) >> 23) - (127 + 4), 0);
    return shift + (((nearest >> shift) - (farthest >> shift)) >> 5);
}

// The bins that the codes low … high pass through; low <= high, both within the cell.
uint bins_between(int low, int high, int farthest, int shift)
{
    int base = farthest >> shift, first = (low >> shift) - base, count = (high >> shift) - base - first;
    return ((2u << count) - 1u) << first;
}

bool cell_may_touch(uvec2 cell, float z_far, float z_near)
{
    int nearest = cell_nearest(cell), farthest = cell_farthest(cell);
    int low = max(depth_code(z_far), farthest), high = min(depth_code(z_near), nearest);
    bool meets = (cell.y & bins_between(low, high, farthest, bin_shift(nearest, farthest))) != 0u;
    return low <= high && meets;
}
