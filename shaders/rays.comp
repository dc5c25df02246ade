// One ray per reflecting pixel, ready to trace. Pixels that do not reflect leave no trace in the list.
#include "segment.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = CONSTANT_EVERY_SURFACE) const int every_surface = 0; // trace what does not reflect, too

layout(set = 0, binding = 4, scalar) buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) writeonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 7, scalar) writeonly buffer RayLengths { real ray_length_m[]; };
layout(set = 0, binding = 8, scalar) writeonly buffer RayPixels { uint ray_pixel[]; }; // number = status of a miss
layout(set = 0, binding = 9, scalar) readonly buffer TileCount { uint tile_count; };
layout(set = 0, binding = 10, scalar) readonly buffer Tiles { uint tiles[]; }; // x | y << 16, in tiles

void main()
{
    uint index = gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x;
    if (index >= tile_count) return;
    ivec2 pixel  = ivec2(tiles[index] & 0xFFFF, tiles[index] >> 16) * 8 + ivec2(gl_LocalInvocationID.xy);
    bool  traced = all(lessThan(pixel, size_px)) && (every_surface != 0 ? has_surface(pixel) : reflects(pixel));

    uvec4 ballot = subgroupBallot(traced);
    uint  first  = 0;
    if (subgroupElect()) first = atomicAdd(ray_count, subgroupBallotBitCount(ballot));
    first = subgroupBroadcastFirst(first);
    if (!traced) return;

    index               = first + subgroupBallotExclusiveBitCount(ballot);
    real2   centre      = real2(pixel) + real(0.5);
    real    depth       = real(imageLoad(depth_image, pixel).x);
    real3   position    = px_to_vs(real3(centre, depth));
    real3   view        = orthographic == 0 ? unit(position) : real3(0, 0, -1);
    Segment segment     = make_segment(centre, depth, position, mirrored(view, normal_at(pixel)));
    ray_origin[index]   = segment.origin;
    ray_delta[index]    = segment.delta;
    ray_length_m[index] = segment.length_m;
    ray_pixel[index]    = pack_pixel(pixel, segment.end_status);
}
