// What a cell of the depth pyramid knows, in two words:
//   x = the nearest front of its pixels, as the bits of a float rounded up to a multiple of 32; bin_shift in the low 5 bits
//   y = 32 bins of depth from there away from the camera, set where any of its pixels' slabs lies; 0: nothing to hit
// Bits of positive floats order like the floats. A bin is 2^bin_shift of them, begins at a multiple of its width, and is as narrow as 32
// bins allow, 2^5 at least: so the bins of a wider cell are unions of those of its quarters.

int bin_shift(uvec2 cell) { return int(cell.x & 31u); }

// The nearest bin: bits of depth >> bin_shift.
int nearest_bin(uvec2 cell) { return int(cell.x) >> bin_shift(cell); }

// Bins first to last, counted from the nearest; 0 <= first <= last <= 31, else any bits.
uint bins_between(int first, int last) { return (~0u << first) & ~(~1u << last); }

bool cell_may_touch(uvec2 cell, float z_far, float z_near)
{
    // Bits of negative numbers are farther than those of any cell.
    int far = floatBitsToInt(z_far), near = floatBitsToInt(z_near), shift = bin_shift(cell);
    int first = max(nearest_bin(cell) - (near >> shift), 0), last = min(nearest_bin(cell) - (far >> shift), 31);
    bool meets = (cell.y & bins_between(first, last)) != 0u;
    return far <= int(cell.x) && first <= last && meets;
}
