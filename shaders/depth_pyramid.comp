// One level of the depth pyramid. A cell (i, j) of level L covers exactly the pixels [i << L, (i + 1) << L) x [j << L, (j + 1) << L):
// cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down as in mip chains).
#include "real.glsl"
#include "slab.glsl"
#include "pyramid_cell.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_PYRAMID_KIND) const int pyramid_kind = PYRAMID_OCCUPANCY;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth_image;
layout(set = 0, binding = 1, rg32ui) uniform uimage2D depth_pyramid;
layout(push_constant, scalar) uniform Push
{
    int   level;
    ivec2 source_size; // cells of level - 1
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
    int  front = depth_code(depth), back = pyramid_kind == PYRAMID_NEAREST ? 0 : depth_code(outer_back(depth));
    uint bins  = pyramid_kind == PYRAMID_OCCUPANCY ? bins_between(back, front) : 0xFFFFFFFFu;
    return uvec2(uint(front) << 16 | uint(back), bins);
}

uvec2 source_cell(ivec2 cell)
{
    if (any(greaterThanEqual(cell, source_size))) return empty_cell;
    return level > 1 ? imageLoad(depth_pyramid, source_offset + cell).xy : pixel_cell(cell);
}

uvec2 merge(uvec2 a, uvec2 b)
{
    uint nearest = max(a.x >> 16, b.x >> 16), farthest = min(a.x & PYRAMID_MAX_CODE, b.x & PYRAMID_MAX_CODE);
    return uvec2(nearest << 16 | farthest, a.y | b.y);
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, size))) return;
    uvec2 top    = merge(source_cell(2 * cell), source_cell(2 * cell + ivec2(1, 0)));
    uvec2 bottom = merge(source_cell(2 * cell + ivec2(0, 1)), source_cell(2 * cell + ivec2(1, 1)));
    imageStore(depth_pyramid, offset + cell, uvec4(merge(top, bottom), 0, 0));
}
