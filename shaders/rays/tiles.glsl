// The tiles of 8 x 8 pixels that shaders/rays/tile_list.glsl lists, one for each workgroup of an indirect launch.
#include "layout/texels.glsl"
#include "layout/workgroups.glsl"

layout(set = 0, binding = 9, scalar) readonly buffer TileCount { uint tile_count; };
// As texels: layout/packed_ray.glsl says why. Two words a tile: x | y << 16, in tiles; pixels traced in those before it.
LOADED_TEXELS_1(10, Tiles)

ivec2 listed_tile()
{
    uint tile = LOAD_TEXEL(Tiles, 2 * work_group()).x;
    return ivec2(tile & 0xFFFF, tile >> 16);
}

uint pixels_before_tile()
{
    return LOAD_TEXEL(Tiles, 2 * work_group() + 1).x;
}

// All invocations of a workgroup get the same answer; the pixel may lie outside the image.
bool listed_pixel(out ivec2 pixel)
{
    bool found = work_group() < tile_count;
    pixel      = (found ? listed_tile() : ivec2(0)) * 8 + ivec2(gl_LocalInvocationID.xy);
    return found;
}
