// How cells are made; level.comp and levels.comp include it. A cell (i, j) of level L covers exactly the pixels
// [i << L, (i + 1) << L) x [j << L, (j + 1) << L): cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down
// as in mip chains). It is made of four quarters: cells of the level below, or of level 1 pixels.
#include "api/held.glsl"
#include "api/structure_api.glsl"
#include "layout/cell_pairs.glsl"
#include "layout/pixel_pairs.glsl"
#include "structure/parameters"
#include "cell.glsl"

layout(push_constant, scalar) uniform Push { int level, last_level; }; // that the dispatch makes

// What a pixel holds in a layer: the bits of its front and of its back; nearest < farthest where there is nothing to hit.
const uvec2 nothing = uvec2(0, 0x7FFFFFFF);
uvec2 pixel_range(ivec2 pixel, int layer, uvec2 words)
{
    float depth = uintBitsToFloat(words.x);
    if (!(depth > 0.0)) return nothing;
    ivec2 held = floatBitsToInt(held_depths(pixel, layer, depth, words.y));
    return uvec2(held.x, depth_pyramid_kind == depth_pyramid_kind_nearest ? 0 : max(held.y, 0));
}

// The same of a quarter: a pixel's is given.
uvec2 range_of(bool is_pixel, uvec2 quarter)
{
    if (is_pixel || int(quarter.x) <= 0) return is_pixel ? quarter : nothing;
    return uvec2(quarter.x & ~31u, (nearest_bin(quarter) - findMSB(quarter.y)) << bin_shift(quarter));
}

uvec2 unite(uvec2 a, uvec2 b) { return uvec2(max(a.x, b.x), min(a.y, b.y)); }

// The bins that a pixel fills: all from its front to its back.
uint bins_of_range(uvec2 cell, uvec2 range)
{
    if (range.x < range.y) return 0u;
    ivec2 bins = nearest_bin(cell) - (ivec2(range) >> bin_shift(cell));
    return bins_between(bins.x, bins.y);
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
uint bins_of(bool is_pixel, uvec2 cell, uvec2 quarter)
{
    if (is_pixel) return bins_of_range(cell, quarter);
    int  shift = bin_shift(quarter), nearest = nearest_bin(quarter);
    uint bins  = int(quarter.x) > 0 ? quarter.y : 0u;
    for (; bins != 0u && shift < bin_shift(cell); ++shift)
    {
        // Pairs end at odd bins; the last one may stand alone behind them.
        int even = ~nearest & 1;
        bins     = unite_pairs(bins << even) | (even == 1 ? bins >> 31 << 16 : 0u);
        nearest >>= 1;
    }
    return bins == 0u ? 0u : bins << (nearest_bin(cell) - nearest);
}

#include "layers_behind.glsl"

// Of quarters two by two: cells of the level below, or the ranges of pixels, of which `first` is the first.
uvec2 cell_of(bool of_pixels, ivec2 first, uvec4 upper, uvec4 lower)
{
    uvec2 above = unite(range_of(of_pixels, upper.xy), range_of(of_pixels, upper.zw));
    uvec2 range = unite(unite(above, range_behind(of_pixels, first)), unite(range_of(of_pixels, lower.xy), range_of(of_pixels, lower.zw)));
    // 32 or 33 bins if they begin at a multiple of 2^shift; never more than 32 with one bit more.
    int front = int(range.x + 31u) & ~31, farthest = int(range.y), shift = max(findMSB(front - farthest) - 4, 5);
    shift += ((front >> shift) - (farthest >> shift)) >> 5;
    uvec2 cell = uvec2(front | shift, 0);
    uint  bins = bins_behind(of_pixels, first, cell) | bins_of(of_pixels, cell, upper.xy) | bins_of(of_pixels, cell, upper.zw);
    bins |= bins_of(of_pixels, cell, lower.xy) | bins_of(of_pixels, cell, lower.zw);
    // Without occupancy everything behind the nearest front counts as full, as far as the farthest back.
    if (bins != 0u && depth_pyramid_kind != depth_pyramid_kind_occupancy) bins = bins_between(0, findMSB(bins));
    return bins == 0u ? uvec2(0) : uvec2(cell.x, bins);
}

// Two quarters side by side. Around the image and around each level there is background, or a cell of background.
uvec4 load_quarters(ivec2 quarter)
{
    if (level > 1) return load_pair(pair_index(quarter, pyramid_root >> (level - 1)));
    uvec4 words = load_pixel_pair(quarter);
    return uvec4(pixel_range(quarter, 0, words.xy), pixel_range(quarter + ivec2(1, 0), 0, words.zw));
}

// The second may lie beyond the level: that place belongs to none.
uvec4 two_cells(ivec2 cell)
{
    ivec2 first = 2 * cell, next = first + ivec2(2, 0), below = ivec2(0, 1);
    return uvec4(cell_of(level == 1, first, load_quarters(first), load_quarters(first + below)),
                 cell_of(level == 1, next, load_quarters(next), load_quarters(next + below)));
}

// Of the dispatch's first level.
void store_cells(ivec2 cell, uvec4 cells) { store_pair(pair_index(cell, pyramid_root >> level), cells); }
