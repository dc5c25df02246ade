// How cells are made; level_of_pixels.comp, level_of_cells.comp and levels.comp include it. A cell (i, j) of level L covers exactly the pixels
// [i << L, (i + 1) << L) x [j << L, (j + 1) << L): cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down
// as in mip chains). Two cells side by side are made at once: fewer reads and writes. The second may lie beyond the level: that place belongs to none.
#include "api/view.glsl"
#include "api/slab.glsl"
#include "api/held.glsl"
#include "cell.glsl"
#include "api/structure_api.glsl"
#include "layout/cell_pairs.glsl"
#include "structure/parameters"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { int level, last_level; }; // that the dispatch makes

// The bits of a pixel's front and back, or of a cell's; nearest < farthest where there is nothing to hit.
struct Range
{
    int nearest, farthest;
};
const Range nothing = Range(0, 0x7FFFFFFF);

// Of one layer. bits: of its depth; around the picture there is background.
Range pixel_range(ivec2 pixel, int layer, uint bits, uint gradient)
{
    float depth = uintBitsToFloat(bits);
    if (!(depth > 0.0)) return nothing;
    vec2 held = held_depths(pixel, layer, depth, gradient);
    return Range(floatBitsToInt(held.x), depth_pyramid_kind == depth_pyramid_kind_nearest ? 0 : max(floatBitsToInt(held.y), 0));
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
    return depth_pyramid_kind == depth_pyramid_kind_occupancy ? cell : uvec2(cell.x, bins_between(0, findMSB(cell.y)));
}

#if LAYERS > 1
#include "pixels_behind.glsl"
#else
Range range_behind(ivec2 first) { return nothing; }
uint  bins_behind(ivec2 first, uvec2 cell) { return 0u; }
#endif

// The cell of two pixels and the two below them: their depths, and their gradients.
uvec2 cell_of_pixels(ivec2 first, uvec4 depths, uvec4 gradients)
{
    Range a = pixel_range(first, 0, depths.x, gradients.x), b = pixel_range(first + ivec2(1, 0), 0, depths.y, gradients.y);
    Range c = pixel_range(first + ivec2(0, 1), 0, depths.z, gradients.z), d = pixel_range(first + 1, 0, depths.w, gradients.w);
    uvec2 cell = cell_of_range(unite(range_behind(first), unite(unite(a, b), unite(c, d))));
    cell.y     = bins_of_pixel(cell, a) | bins_of_pixel(cell, b) | bins_of_pixel(cell, c) | bins_of_pixel(cell, d) | bins_behind(first, cell);
    return finished(cell);
}

// Of pixels; around the image there is background.
uvec4 two_cells_of_pixels(ivec2 cell)
{
    ivec2 first = 2 * cell, below = first + ivec2(0, 1);
    uvec4 upper = load_pair(pair_index(cell * ivec2(1, 2), pyramid_root)), lower = load_pair(pair_index(cell * ivec2(1, 2) + ivec2(0, 1), pyramid_root));
    uvec4 upper_gradients = load_gradients(first), lower_gradients = load_gradients(below);
    return uvec4(cell_of_pixels(first, uvec4(upper.xy, lower.xy), uvec4(upper_gradients.xy, lower_gradients.xy)),
                 cell_of_pixels(first + ivec2(2, 0), uvec4(upper.zw, lower.zw), uvec4(upper_gradients.zw, lower_gradients.zw)));
}

// Of quarters two by two.
uvec2 cell_of_quarters(uvec4 upper, uvec4 lower)
{
    Range range = unite(unite(cell_range(upper.xy), cell_range(upper.zw)), unite(cell_range(lower.xy), cell_range(lower.zw)));
    uvec2 cell  = cell_of_range(range);
    cell.y      = bins_of_quarter(cell, upper.xy) | bins_of_quarter(cell, upper.zw);
    cell.y |= bins_of_quarter(cell, lower.xy) | bins_of_quarter(cell, lower.zw);
    return finished(cell);
}

// Two quarters of a cell side by side: a cell of the level below and its right neighbour, empty where that level ends.
uvec4 load_quarters(ivec2 quarter)
{
    ivec2 source_size = level_size(level - 1);
    bvec3 inside = lessThan(ivec3(quarter, quarter.x + 1), source_size.xyx);
    uvec4 pair   = inside.y ? load_pair(pair_index(quarter, pyramid_root >> (level - 1))) : uvec4(0);
    return uvec4(inside.x ? pair.xy : empty_cell, inside.z ? pair.zw : empty_cell);
}

uvec4 two_cells_of_cells(ivec2 cell)
{
    ivec2 first = 2 * cell, next = first + ivec2(2, 0), below = ivec2(0, 1);
    return uvec4(cell_of_quarters(load_quarters(first), load_quarters(first + below)),
                 cell_of_quarters(load_quarters(next), load_quarters(next + below)));
}

// Two cells side by side of the dispatch's first level, and the first of the two that an invocation makes.
void store_cells(ivec2 cell, uvec4 cells) { store_pair(pair_index(cell, pyramid_root >> level), cells); }
ivec2 size = level_size(level), own = ivec2(2, 1) * ivec2(gl_GlobalInvocationID.xy);
