// Rays ready to trace: for each pixel that reflects the screen-space segment of its mirror ray, clipped to the near plane, the image and
// the maximum distance (docs/hit_contract.md). Pixels that do not reflect leave no trace in the list.
// By the effects' parameters there are several rays per pixel, one after the other in the list, or one pixel for each block of pixels.
#include "view.glsl"
#include "reflecting.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1;
layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0;
layout(constant_id = CONSTANT_EVERY_SURFACE) const int every_surface = 0; // trace what does not reflect, too
layout(constant_id = CONSTANT_RAYS_PER_PIXEL) const int rays_per_pixel = 1;
layout(constant_id = CONSTANT_TRACE_BLOCK_PX) const int block_px = 1;

layout(set = 0, binding = 4, scalar) buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) writeonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 7, scalar) writeonly buffer RayLengths { real ray_length_m[]; };
layout(set = 0, binding = 8, scalar) writeonly buffer RayPixels { uint ray_pixel[]; }; // number = status of a miss
layout(set = 0, binding = 9, scalar) readonly buffer TileCount { uint tile_count; };
layout(set = 0, binding = 10, scalar) readonly buffer Tiles { uint tiles[]; }; // x | y << 16, in tiles

struct Segment
{
    real3 origin; // x_px, y_px, depth
    real3 delta;
    real  length_m;
    int   end_status;
};

// normalize() may be rounded differently from device to device; this may not.
real3 unit(real3 v)
{
    precise real square = v.x * v.x + v.y * v.y + v.z * v.z;
    precise real3 result = v * (real(1) / sqrt(square));
    return result;
}

real3 mirrored(real3 view, real3 normal)
{
    precise real  cosine = normal.x * view.x + normal.y * view.y + normal.z * view.z;
    precise real3 result = view - real(2) * cosine * normal;
    return unit(result);
}

// Distance along the ray at which value + s * slope falls to zero, if that is nearer than `limit`.
void limit_by(real value, real slope, int side, inout real limit, inout int limiting_side)
{
    real s = max(value, real(0)) / -slope;
    if (slope < real(0) && s < limit)
    {
        limit         = s;
        limiting_side = side;
    }
}

#define SIDE_MAX_DISTANCE 0
#define SIDE_NEAR 1
#define SIDE_LEFT 2
#define SIDE_RIGHT 3
#define SIDE_TOP 4
#define SIDE_BOTTOM 5

// Length of the ray inside the view volume. The border planes are used in homogeneous form, so nothing is divided
// by a distance that may vanish.
real clip_length(real3 position, real3 direction, out int side)
{
    real limit = max_distance_m;
    side       = SIDE_MAX_DISTANCE;
    real distance_m = -position.z;
    real rate       = -direction.z;
    limit_by(distance_m - near_m, rate, SIDE_NEAR, limit, side);
    if (orthographic != 0) limit_by(far_m - distance_m, -rate, SIDE_MAX_DISTANCE, limit, side);
    real w_value = orthographic == 0 ? distance_m : real(1);
    real w_slope = orthographic == 0 ? rate : real(0);
    real2         to_px   = real2(focal_px.x, -focal_px.y);
    real2         rest_px = real2(size_px) - centre_px;
    precise real2 value = to_px * position.xy, slope = to_px * direction.xy;
    precise real2 value_low = centre_px * w_value + value, slope_low = centre_px * w_slope + slope;
    precise real2 value_high = rest_px * w_value - value, slope_high = rest_px * w_slope - slope;
    limit_by(value_low.x, slope_low.x, SIDE_LEFT, limit, side);
    limit_by(value_high.x, slope_high.x, SIDE_RIGHT, limit, side);
    limit_by(value_low.y, slope_low.y, SIDE_TOP, limit, side);
    limit_by(value_high.y, slope_high.y, SIDE_BOTTOM, limit, side);
    return limit;
}

// From the projection of `position` to that of position + length_m * direction, with the common terms cancelled by hand: no difference of
// two projected points is taken, infinity is a length like any other, and mirrored rays have exactly mirrored deltas.
real3 screen_delta(real3 position, real3 direction, real length_m)
{
    precise real3 delta;
    if (orthographic != 0)
    {
        delta = length_m * real3(focal_px.x * direction.x, -focal_px.y * direction.y, direction.z / (far_m - near_m));
        return delta;
    }
    real          distance_m = -position.z;
    precise real  scale      = real(1) / ((distance_m / length_m - direction.z) * distance_m);
    precise real2 slope      = direction.xy * distance_m + position.xy * direction.z;
    delta = scale * real3(focal_px.x * slope.x, -focal_px.y * slope.y, near_m * direction.z);
    return delta;
}

// Pixel position and depth of a point in front of the camera.
real3 vs_to_px(real3 position)
{
    real  distance_m = -position.z;
    real2 to_px      = real2(focal_px.x, -focal_px.y);
    if (orthographic != 0) return real3(centre_px + to_px * position.xy, (far_m - distance_m) / (far_m - near_m));
    return real3(centre_px + to_px * position.xy * (real(1) / distance_m), near_m / distance_m);
}

// A ray starts on the surface seen at start_px.
Segment make_segment(real2 start_px, real depth, real3 normal)
{
    real2 slope      = px_to_slope(start_px);
    real  distance_m = depth_to_distance(depth);
    real3 position   = real3(orthographic == 0 ? slope * distance_m : slope, -distance_m);
    real3 view       = orthographic == 0 ? unit(position) : real3(0, 0, -1);
    real3 direction  = mirrored(view, normal);

    int  side;
    real length_m = clip_length(position, direction, side);
    Segment segment;
    segment.origin     = real3(start_px, depth);
    segment.delta      = real3(0);
    segment.length_m   = length_m;
    segment.end_status = side == SIDE_MAX_DISTANCE ? TRACE_PAST_MAX_DISTANCE : TRACE_LEFT_SCREEN;
    if (length_m <= ray_offset_m || length_m <= real(0)) return segment;

    if (ray_offset_m > real(0))
    {
        position += ray_offset_m * direction;
        segment.origin    = vs_to_px(position);
        segment.origin.xy = clamp(segment.origin.xy, real2(0), real2(size_px));
        segment.length_m -= ray_offset_m;
    }
    // The end lies exactly on the border that limits the ray, and inside the image on the other axis.
    real2 low = -segment.origin.xy, high = real2(size_px) - segment.origin.xy;
    real3 delta = screen_delta(position, direction, segment.length_m);
    delta.xy    = clamp(delta.xy, low, high);
    if (side == SIDE_LEFT) delta.x = low.x;
    if (side == SIDE_RIGHT) delta.x = high.x;
    if (side == SIDE_TOP) delta.y = low.y;
    if (side == SIDE_BOTTOM) delta.y = high.y;
    segment.delta = delta;
    return segment;
}

// Scaled by its largest component first: squares of very small or large numbers leave the range of float.
real3 normal_at(ivec2 pixel)
{
    vec3  stored  = imageLoad(normal_image, pixel).xyz;
    float largest = max(max(abs(stored.x), abs(stored.y)), abs(stored.z));
    real3 scaled  = real3(stored) / real(largest);
    return unit(scaled);
}

// PCG hash: M. Jarzynski and M. Olano 2020, Hash Functions for GPU Rendering.
uint pcg(uint value)
{
    uint state = value * 747796405u + 2891336453u;
    uint word  = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

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
    uint index = gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x;
    if (index >= tile_count) return;
    ivec2 pixel      = ivec2(tiles[index] & 0xFFFF, tiles[index] >> 16) * 8 + ivec2(gl_LocalInvocationID.xy);
    bool  inside     = all(lessThan(pixel, size_px));
    bool  reflecting = inside && reflects(pixel);
    bool  traced     = reflecting || (every_surface != 0 && inside && has_surface(pixel));
    if (block_px > 1) traced = first_of_block(pixel, reflecting) || (traced && !reflecting);

    uvec4 ballot = subgroupBallot(traced);
    uint  first  = 0;
    if (subgroupElect()) first = atomicAdd(ray_count, subgroupBallotBitCount(ballot) * rays_per_pixel);
    first = subgroupBroadcastFirst(first);
    if (!traced) return;

    index        = first + subgroupBallotExclusiveBitCount(ballot) * rays_per_pixel;
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
        Segment segment           = make_segment(start_px, start_depth, normal);
        ray_origin[index + ray]   = segment.origin;
        ray_delta[index + ray]    = segment.delta;
        ray_length_m[index + ray] = segment.length_m;
        ray_pixel[index + ray]    = pack_pixel(pixel, segment.end_status);
    }
}
