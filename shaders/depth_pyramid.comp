// One level of the depth pyramid. A cell (i, j) of level L covers exactly the pixels [i << L, (i + 1) << L) x [j << L, (j + 1) << L):
// cell = pixel >> level at any image size, odd, prime or 1 x N (level sizes are rounded up, not down as in mip chains).
// A cell holds the nearest front and the farthest slab back of its pixels; background takes part in neither.
#include "real.glsl"
#include "slab.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_PYRAMID_KIND) const int pyramid_kind = PYRAMID_MINMAX;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth_image;
layout(set = 0, binding = 1, rg32f) uniform image2D depth_pyramid;
layout(push_constant, scalar) uniform Push
{
    int   level;
    ivec2 source_size; // cells of level - 1
    ivec2 size;        // cells of this level
    ivec2 source_offset;
    ivec2 offset;      // where this level lies in the atlas
};

const vec2 empty_cell = vec2(BACKGROUND_DEPTH, 2.0); // no interval touches it

// Rounded outward: wider than any rounding of the test on the pixel itself.
float conservative_back(float depth)
{
    const float margin = 1.0 - 1.0 / 1048576.0;
    float back = float(slab_back(real(depth)));
    return back >= 0.0 ? back * margin : back / margin - 1e-6;
}

vec2 source_cell(ivec2 cell)
{
    if (any(greaterThanEqual(cell, source_size))) return empty_cell;
    if (level > 1) return imageLoad(depth_pyramid, source_offset + cell).xy;
    float depth = imageLoad(depth_image, cell).x;
    return depth > 0.0 ? vec2(depth, pyramid_kind == PYRAMID_MINMAX ? conservative_back(depth) : -1e30) : empty_cell;
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, size))) return;
    vec2 a = source_cell(2 * cell), b = source_cell(2 * cell + ivec2(1, 0));
    vec2 c = source_cell(2 * cell + ivec2(0, 1)), d = source_cell(2 * cell + ivec2(1, 1));
    vec2 node = vec2(max(max(a.x, b.x), max(c.x, d.x)), min(min(a.y, b.y), min(c.y, d.y)));
    imageStore(depth_pyramid, offset + cell, vec4(node, 0, 0));
}
