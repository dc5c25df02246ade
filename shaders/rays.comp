// Rays ready to trace: for each pixel that reflects the screen-space segment of its mirror ray. Pixels that do not reflect leave no trace in
// the list.
// By the effects' parameters there are several rays per pixel, one after the other in the list, or one pixel for each block of pixels.
#include "segment.glsl"
#include "hash.glsl"
#include "effects/tiles.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = CONSTANT_EVERY_SURFACE) const int every_surface = 0; // trace what does not reflect, too
layout(constant_id = CONSTANT_RAYS_PER_PIXEL) const int rays_per_pixel = 1;
layout(constant_id = CONSTANT_TRACE_BLOCK_PX) const int block_px = 1;

layout(set = 0, binding = 4, scalar) buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) writeonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 7, scalar) writeonly buffer RayLengths { real ray_length_m[]; };
layout(set = 0, binding = 8, scalar) writeonly buffer RayPixels { uint ray_pixel[]; }; // number = status of a miss

// A place inside the pixel, exact in float. The depth image is flat inside each pixel: a ray that starts on the far side of its pixel's
// centre and runs sideways is behind its neighbour's slab face, which ray_offset_m > 0 avoids.
real2 offset_start(ivec2 pixel, int ray)
{
    uint  random = pcg(uint(pixel.x) + pcg(uint(pixel.y) + pcg(uint(ray))));
    uvec2 cell   = uvec2(random, random >> 16) % OFFSET_CELLS;
    return real2(pixel) + (real2(cell) + real(0.5)) / real(OFFSET_CELLS);
}

// Depth at start_px of the plane through the pixel's point with its normal; 0 where that is less than half or more than twice as far
// as the point: the plane is seen edge-on.
real plane_depth(ivec2 pixel, real depth, real3 normal, real2 start_px)
{
    real2 slope = px_to_slope(real2(pixel) + real(0.5)), start_slope = px_to_slope(start_px);
    real  start_depth;
    if (orthographic == 0)
        start_depth = depth * (dot(normal.xy, start_slope) - normal.z) / (dot(normal.xy, slope) - normal.z);
    else
        start_depth = depth - dot(normal.xy, start_slope - slope) / normal.z / (far_m - near_m);
    real farther = depth_to_distance(start_depth) / depth_to_distance(depth);
    bool usable  = start_depth > real(0) && start_depth <= real(1) && farther >= real(0.5) && farther <= real(2);
    return usable ? start_depth : real(0);
}

// The pixels of a block from its centre outward, row by row where equally far.
int rank_in_block(ivec2 pixel)
{
    ivec2 place  = pixel % block_px;
    ivec2 offset = 2 * place - (block_px - 1);
    return (offset.x * offset.x + offset.y * offset.y) * 16 + place.y * block_px + place.x;
}

shared int first_rank[16]; // of the pixels that reflect, for each block of the tile

// A block is traced from the first of its pixels that reflects. Called by all invocations.
bool first_of_block(ivec2 pixel, bool reflecting)
{
    ivec2 block = pixel % 8 / block_px;
    int   index = block.y * (8 / block_px) + block.x;
    if (gl_LocalInvocationIndex < 16) first_rank[gl_LocalInvocationIndex] = 1 << 16;
    barrier();
    if (reflecting) atomicMin(first_rank[index], rank_in_block(pixel));
    barrier();
    return reflecting && first_rank[index] == rank_in_block(pixel);
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel)) return;
    bool  inside     = all(lessThan(pixel, size_px));
    bool  reflecting = inside && reflects(pixel);
    bool  traced     = reflecting || (every_surface != 0 && inside && has_surface(pixel));
    if (block_px > 1) traced = first_of_block(pixel, reflecting) || (traced && !reflecting);

    uvec4 ballot = subgroupBallot(traced);
    uint  first  = 0;
    if (subgroupElect()) first = atomicAdd(ray_count, subgroupBallotBitCount(ballot) * rays_per_pixel);
    first = subgroupBroadcastFirst(first);
    if (!traced) return;

    uint  index  = first + subgroupBallotExclusiveBitCount(ballot) * rays_per_pixel;
    real  depth  = real(imageLoad(depth_image, pixel).x);
    real3 normal = normal_at(pixel);
    for (int ray = 0; ray < rays_per_pixel; ++ray)
    {
        real2 start_px    = real2(pixel) + real(0.5);
        real  start_depth = depth;
        if (rays_per_pixel > 1)
        {
            real2 offset_px    = offset_start(pixel, ray);
            real  offset_depth = plane_depth(pixel, depth, normal, offset_px);
            start_px           = offset_depth > real(0) ? offset_px : start_px;
            start_depth        = offset_depth > real(0) ? offset_depth : depth;
        }
        Segment segment           = make_segment(start_px, start_depth, mirrored(view_direction(start_px), normal));
        ray_origin[index + ray]   = segment.origin;
        ray_delta[index + ray]    = segment.delta;
        ray_length_m[index + ray] = segment.length_m;
        ray_pixel[index + ray]    = pack_pixel(pixel, segment.end_status);
    }
}
