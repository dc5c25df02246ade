// One level of the depth pyramid. A cell (i, j) of level L covers exactly the pixels [i << L, (i + 1) << L) x [j << L, (j + 1) << L):
// cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down as in mip chains).
#include "api/real.glsl"
#include "api/slab.glsl"
#include "pyramid_cell.glsl"
#include "layout/shared.h"
#include "layout/store_texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_PYRAMID_KIND) const int pyramid_kind = PYRAMID_OCCUPANCY;
// Level 1 is made from pixels, in a pipeline of its own: a branch would run both sides.
layout(constant_id = CONSTANT_FROM_PIXELS) const int from_pixels = 0;
// Two cells, or four pixels, a texel: fewer reads and writes. Every row and every level begins with a whole one.
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimageBuffer cell_pairs;
STORED_TEXELS_4(2, StoredCells)
layout(push_constant, scalar) uniform Push
{
    ivec2 source_size; // cells of the level below
    ivec2 size;        // cells of this level
    int   row;         // where it begins
    int   rows;        // of the whole pyramid
};

// The slab's back, rounded outward: wider than any rounding of the test on the pixel itself.
float outer_back(float depth)
{
    const float margin = 1.0 - 1.0 / 1048576.0;
    return float(slab_back(real(depth))) * margin;
}

// The bits of a pixel's front and back, or of a cell's; nearest < farthest where there is nothing to hit.
struct Range
{
    int nearest, farthest;
};
const Range nothing = Range(0, 0x7FFFFFFF);

// bits: of its depth; around the picture there is background.
Range pixel_range(uint bits)
{
    float depth = uintBitsToFloat(bits);
    if (!(depth > 0.0)) return nothing;
    return Range(floatBitsToInt(depth), pyramid_kind == PYRAMID_NEAREST ? 0 : max(floatBitsToInt(outer_back(depth)), 0));
}

// A cell and its right neighbour. place: the cell, counted from the heap's first row.
int pair_at(ivec2 place)
{
    return strip_index(place.x, place.y, rows) >> 1;
}

// Two quarters of a cell side by side: a cell of the level below and its right neighbour, empty where that level ends.
uvec4 source_pair(ivec2 cell)
{
    bvec3 inside = lessThan(ivec3(cell, cell.x + 1), source_size.xyx);
    uvec4 pair   = inside.y ? imageLoad(cell_pairs, pair_at(ivec2(cell.x, 2 * row + cell.y))) : uvec4(0);
    return uvec4(inside.x ? pair.xy : empty_cell, inside.z ? pair.zw : empty_cell);
}

Range cell_range(uvec2 cell)
{
    if (cell.y == 0u) return nothing;
    return Range(int(cell.x) & ~31, (nearest_bin(cell) - findMSB(cell.y)) << bin_shift(cell));
}

Range unite(Range a, Range b)
{
    return Range(max(a.nearest, b.nearest), min(a.farthest, b.farthest));
}

// A cell of this range, without bins yet.
uvec2 cell_of_range(Range range)
{
    int front = (range.nearest + 31) & ~31;
    // 32 or 33 bins if they begin at a multiple of 2^shift; never more than 32 with one bit more.
    int shift = max(findMSB(front - range.farthest) - 4, FINEST_BIN_SHIFT);
    shift += ((front >> shift) - (range.farthest >> shift)) >> 5;
    return uvec2(front | shift, 0);
}

// A pixel fills all bins from its front to its back.
uint bins_of_pixel(uvec2 cell, Range pixel)
{
    if (pixel.nearest < pixel.farthest) return 0u;
    int shift = bin_shift(cell), nearest = nearest_bin(cell);
    return bins_between(nearest - (pixel.nearest >> shift), nearest - (pixel.farthest >> shift));
}

// Neighbouring bits united, in the lower half.
uint unite_pairs(uint bits)
{
    bits = (bits | bits >> 1) & 0x55555555u; // in even places, then these moved together
    bits = (bits | bits >> 1) & 0x33333333u;
    bits = (bits | bits >> 2) & 0x0F0F0F0Fu;
    bits = (bits | bits >> 4) & 0x00FF00FFu;
    return (bits | bits >> 8) & 0x0000FFFFu;
}

// The bins of a quarter in terms of the whole cell.
uint bins_of_quarter(uvec2 cell, uvec2 quarter)
{
    int  shift = bin_shift(quarter), nearest = nearest_bin(quarter);
    uint bins  = quarter.y;
    while (bins != 0u && shift < bin_shift(cell))
    {
        // Pairs end at odd bins; the last one may stand alone behind them.
        int  even = ~nearest & 1;
        uint last = even == 1 ? bins >> 31 << 16 : 0u;
        bins = unite_pairs(bins << even) | last;
        nearest >>= 1;
        ++shift;
    }
    return bins == 0u ? 0u : bins << (nearest_bin(cell) - nearest);
}

// Without occupancy everything behind the nearest front counts as full, as far as the farthest back.
uvec2 finished(uvec2 cell)
{
    if (cell.y == 0u) return empty_cell;
    return pyramid_kind == PYRAMID_OCCUPANCY ? cell : uvec2(cell.x, bins_between(0, findMSB(cell.y)));
}

// The cell of two pixels and the two below them.
uvec2 cell_of_pixels(uvec2 upper, uvec2 lower)
{
    Range a = pixel_range(upper.x), b = pixel_range(upper.y), c = pixel_range(lower.x), d = pixel_range(lower.y);
    uvec2 cell = cell_of_range(unite(unite(a, b), unite(c, d)));
    cell.y     = bins_of_pixel(cell, a) | bins_of_pixel(cell, b) | bins_of_pixel(cell, c) | bins_of_pixel(cell, d);
    return finished(cell);
}

uvec2 cell_of_quarters(uvec4 upper, uvec4 lower)
{
    Range range = unite(unite(cell_range(upper.xy), cell_range(upper.zw)), unite(cell_range(lower.xy), cell_range(lower.zw)));
    uvec2 cell  = cell_of_range(range);
    cell.y      = bins_of_quarter(cell, upper.xy) | bins_of_quarter(cell, upper.zw);
    cell.y |= bins_of_quarter(cell, lower.xy) | bins_of_quarter(cell, lower.zw);
    return finished(cell);
}

// An invocation makes two cells side by side. The second may lie beyond the level: that place belongs to none.
void main()
{
    ivec2 position = ivec2(2, 1) * ivec2(gl_GlobalInvocationID.xy), first = 2 * position, place = position + ivec2(0, row);
    if (any(greaterThanEqual(position, size))) return;
    const ivec2 next = ivec2(2, 0), below = ivec2(0, 1);
    uvec4 cells;
    if (from_pixels != 0)
    {
        ivec2 pair  = ivec2(place.x, 2 * place.y);
        uvec4 upper = imageLoad(cell_pairs, pair_at(pair)), lower = imageLoad(cell_pairs, pair_at(pair + below));
        cells       = uvec4(cell_of_pixels(upper.xy, lower.xy), cell_of_pixels(upper.zw, lower.zw));
    }
    else
    {
        cells.xy = cell_of_quarters(source_pair(first), source_pair(first + below));
        cells.zw = cell_of_quarters(source_pair(first + next), source_pair(first + next + below));
    }
    STORE_TEXEL(StoredCells, pair_at(place), cells);
}
