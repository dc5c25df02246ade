// One level of the depth pyramid. A cell (i, j) of level L covers exactly the pixels [i << L, (i + 1) << L) x [j << L, (j + 1) << L):
// cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down as in mip chains).
#include "real.glsl"
#include "slab.glsl"
#include "pyramid_cell.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_PYRAMID_KIND) const int pyramid_kind = PYRAMID_OCCUPANCY;
// Level 1 is made from pixels, in a pipeline of its own: a branch would run both sides.
layout(constant_id = CONSTANT_FROM_PIXELS) const int from_pixels = 0;
layout(set = 0, binding = 1, rg32ui) uniform uimageBuffer depth_pyramid;
layout(push_constant, scalar) uniform Push
{
    ivec2 source_size; // cells of the level below
    ivec2 size;        // cells of this level
    ivec2 source_offset;
    ivec2 offset;      // where this level lies in the atlas
    int   atlas_width; // cells
    int   atlas_begin; // texels
    int   pairs_a_row; // level 0 comes before the atlas, two pixels in the place of a cell
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

// bits: of its depth, or anything outside the picture.
Range pixel_range(ivec2 pixel, uint bits)
{
    float depth = any(greaterThanEqual(pixel, source_size)) ? 0.0 : uintBitsToFloat(bits);
    if (!(depth > 0.0)) return nothing;
    return Range(floatBitsToInt(depth), pyramid_kind == PYRAMID_NEAREST ? 0 : max(floatBitsToInt(outer_back(depth)), 0));
}

// A row is as wide as the whole atlas.
int index_of(ivec2 place)
{
    return atlas_begin + place.y * atlas_width + place.x;
}

uvec2 source_cell(ivec2 cell)
{
    return any(greaterThanEqual(cell, source_size)) ? empty_cell : imageLoad(depth_pyramid, index_of(source_offset + cell)).xy;
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

void main()
{
    ivec2 position = ivec2(gl_GlobalInvocationID.xy), first = 2 * position;
    if (any(greaterThanEqual(position, size))) return;
    const ivec2 right = ivec2(1, 0), below = ivec2(0, 1);
    uvec2 cell;
    if (from_pixels != 0)
    {
        int   pair  = first.y * pairs_a_row + position.x;
        uvec2 upper = imageLoad(depth_pyramid, pair).xy, lower = imageLoad(depth_pyramid, pair + pairs_a_row).xy;
        Range a = pixel_range(first, upper.x), b = pixel_range(first + right, upper.y);
        Range c = pixel_range(first + below, lower.x), d = pixel_range(first + right + below, lower.y);
        cell    = cell_of_range(unite(unite(a, b), unite(c, d)));
        cell.y  = bins_of_pixel(cell, a) | bins_of_pixel(cell, b) | bins_of_pixel(cell, c) | bins_of_pixel(cell, d);
    }
    else
    {
        uvec2 a = source_cell(first), b = source_cell(first + right), c = source_cell(first + below), d = source_cell(first + right + below);
        cell    = cell_of_range(unite(unite(cell_range(a), cell_range(b)), unite(cell_range(c), cell_range(d))));
        cell.y  = bins_of_quarter(cell, a) | bins_of_quarter(cell, b) | bins_of_quarter(cell, c) | bins_of_quarter(cell, d);
    }
    // Without occupancy everything behind the nearest front counts as full, as far as the farthest back.
    if (pyramid_kind != PYRAMID_OCCUPANCY && cell.y != 0u) cell.y = bins_between(0, findMSB(cell.y));
    imageStore(depth_pyramid, index_of(offset + position), uvec4(cell.y != 0u ? cell : empty_cell, 0, 0));
}
