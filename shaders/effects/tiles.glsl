// The tiles of 8 x 8 pixels that shaders/tile_list.comp lists, one for each workgroup of an indirect launch.
#include "work_group.glsl"

layout(set = 0, binding = 9, scalar) readonly buffer TileCount { uint tile_count, traced_pixels; };
layout(set = 0, binding = 10, scalar) readonly buffer Tiles { uvec2 tiles[]; }; // x | y << 16, in tiles; pixels traced in those before it

ivec2 listed_tile()
{
    uint tile = tiles[work_group()].x;
    return ivec2(tile & 0xFFFF, tile >> 16);
}

// All invocations of a workgroup get the same answer; the pixel may lie outside the image.
bool listed_pixel(out ivec2 pixel)
{
    bool found = work_group() < tile_count;
    pixel      = (found ? listed_tile() : ivec2(0)) * 8 + ivec2(gl_LocalInvocationID.xy);
    return found;
}
