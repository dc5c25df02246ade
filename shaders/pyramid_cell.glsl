// What a cell of the depth pyramid knows, in two words:
//   x = code of the nearest front << 16 | code of the farthest slab back of its pixels
//   y = 32 bins of depth, set where any of its pixels' slabs lies
// A depth code is the top of the number's own bits: monotone, exact to 2^-11, no logarithm needed. A bin is an eighth of an octave, taken modulo 32:
// intervals that share no bin are apart, whatever the range of depths; those four octaves apart may share one, which costs a visit and never a hit.
#include "shared.h"

const uvec2 empty_cell = uvec2(PYRAMID_MAX_CODE, 0); // nearest 0, farthest beyond everything, no bin

// Monotone in depth; depths below 2^-31, zero and negative numbers are all 0. NaN does not occur.
int depth_code(float depth)
{
    return max((floatBitsToInt(depth) >> 12) - (PYRAMID_LOWEST_EXPONENT << 11), 0);
}

// The bins that the codes low … high pass through.
uint bins_between(int low, int high)
{
    int  first = low >> 8, count = (high >> 8) - first;
    uint run   = count >= 31 ? 0xFFFFFFFFu : (2u << count) - 1u;
    int  shift = first & 31;
    return run << shift | run >> ((32 - shift) & 31);
}

bool cell_may_touch(uvec2 cell, float z_far, float z_near)
{
    int low = depth_code(z_far), high = depth_code(z_near);
    return int(cell.x >> 16) >= low && int(cell.x & PYRAMID_MAX_CODE) <= high && (cell.y & bins_between(low, high)) != 0u;
}
