// The tiles of 8 x 8 pixels that effects/classification.comp lists, one for each workgroup of an indirect launch.
layout(set = 0, binding = 9, scalar) readonly buffer TileCount { uint tile_count; };
layout(set = 0, binding = 10, scalar) readonly buffer Tiles { uint tiles[]; }; // x | y << 16, in tiles

// All invocations of a workgroup get the same answer; the pixel may lie outside the image.
bool listed_pixel(out ivec2 pixel)
{
    uint index = gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x;
    bool found = index < tile_count;
    uint tile  = found ? tiles[index] : 0;
    pixel      = ivec2(tile & 0xFFFF, tile >> 16) * 8 + ivec2(gl_LocalInvocationID.xy);
    return found;
}
