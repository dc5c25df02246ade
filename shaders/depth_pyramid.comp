// One level of the depth pyramid. A cell (i, j) of level L covers exactly the pixels [i << L, (i + 1) << L) x [j << L, (j + 1) << L):
// cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down as in mip chains).
#include "real.glsl"
#include "slab.glsl"
#include "pyramid_cell.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_PYRAMID_KIND) const int pyramid_kind = PYRAMID_OCCUPANCY;
// Level 1 is made from pixels, in a pipeline of its own: a branch would run both sides.
layout(constant_id = CONSTANT_FROM_PIXELS) const int from_pixels = 0;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth_image;
layout(set = 0, binding = 1, rg32ui) uniform uimage2D depth_pyramid;
layout(push_constant, scalar) uniform Push
{
    ivec2 source_size; // cells of the level below
    ivec2 size;        // cells of this level
    ivec2 source_offset;
    ivec2 offset;      // where this level lies in the atlas
};

// The slab's back, rounded outward: wider than any rounding of the test on the pixel itself.
float outer_back(float depth)
{
    const float margin = 1.0 - 1.0 / 1048576.0;
    return float(slab_back(real(depth))) * margin;
}

uvec2 pixel_cell(ivec2 pixel)
{
    float depth = imageLoad(depth_image, pixel).x;
    if (!(depth > 0.0)) return empty_cell;
    int front = depth_code(depth), back = pyramid_kind == PYRAMID_NEAREST ? 0 : depth_code(outer_back(depth));
    return uvec2(uint(front) << 16 | uint(back), 1);
}

uvec2 source_cell(ivec2 cell)
{
    if (any(greaterThanEqual(cell, source_size))) return empty_cell;
    return from_pixels == 0 ? imageLoad(depth_pyramid, source_offset + cell).xy : pixel_cell(cell);
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

// The bins of a part in terms of the whole cell. A pixel fills all from its back to its front.
uint bins_of_part(uvec2 part, int farthest, int shift)
{
    if (from_pixels != 0) return part.y == 0u ? 0u : bins_between(cell_farthest(part), cell_nearest(part), farthest, shift);
    int  part_shift = bin_shift(cell_nearest(part), cell_farthest(part)), base = cell_farthest(part) >> part_shift;
    uint bins       = part.y;
    while (bins != 0u && part_shift < shift)
    {
        // Pairs begin at even bins; the last one may stand alone behind them.
        int  odd  = base & 1;
        uint last = odd == 1 ? bins >> 31 << 16 : 0u;
        bins = unite_pairs(bins << odd) | last;
        base >>= 1;
        ++part_shift;
    }
    return bins == 0u ? 0u : bins << (base - (farthest >> shift));
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, size))) return;
    uvec2 a = source_cell(2 * cell), b = source_cell(2 * cell + ivec2(1, 0));
    uvec2 c = source_cell(2 * cell + ivec2(0, 1)), d = source_cell(2 * cell + ivec2(1, 1));

    int  nearest  = max(max(cell_nearest(a), cell_nearest(b)), max(cell_nearest(c), cell_nearest(d)));
    int  farthest = min(min(cell_farthest(a), cell_farthest(b)), min(cell_farthest(c), cell_farthest(d)));
    uint bins     = a.y | b.y | c.y | d.y;
    if (pyramid_kind == PYRAMID_OCCUPANCY)
    {
        int shift = bin_shift(nearest, farthest);
        bins = bins_of_part(a, farthest, shift) | bins_of_part(b, farthest, shift) | bins_of_part(c, farthest, shift) | bins_of_part(d, farthest, shift);
    }
    else bins = bins != 0u ? 0xFFFFFFFFu : 0u;
    imageStore(depth_pyramid, offset + cell, uvec4(uint(nearest) << 16 | uint(farthest), bins, 0, 0));
}
