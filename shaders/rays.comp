// One ray per reflecting pixel, ready to trace: the screen-space segment clipped to the near plane, the image and the
// maximum distance (docs/hit_contract.md). Pixels that do not reflect leave no trace in the list.
#include "view.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1;
layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0;

layout(set = 0, binding = 1, r32f) uniform readonly image2D depth_image;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D normal_image;   // xyz = view-space normal, w = roughness
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D material_image; // rgb = base colour, a = metallic
layout(set = 0, binding = 4, scalar) buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) writeonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) writeonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 7, scalar) writeonly buffer RayLengths { real ray_length_m[]; };
layout(set = 0, binding = 8, scalar) writeonly buffer RayPixels { uint ray_pixel[]; }; // number = status of a miss

struct Segment
{
    real3 origin; // x_px, y_px, depth
    real3 delta;
    real  length_m;
    int   end_status;
};

// Distance along the ray at which value + s * slope falls to zero, if that is nearer than `limit`.
void limit_by(real value, real slope, int side, inout real limit, inout int limiting_side)
{
    real s = value / -slope;
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
    real2 to_px  = real2(focal_px.x, -focal_px.y);
    real2 value  = centre_px * w_value + to_px * position.xy;
    real2 slope  = centre_px * w_slope + to_px * direction.xy;
    real2 size   = real2(size_px);
    limit_by(value.x, slope.x, SIDE_LEFT, limit, side);
    limit_by(size.x * w_value - value.x, size.x * w_slope - slope.x, SIDE_RIGHT, limit, side);
    limit_by(value.y, slope.y, SIDE_TOP, limit, side);
    limit_by(size.y * w_value - value.y, size.y * w_slope - slope.y, SIDE_BOTTOM, limit, side);
    return limit;
}

// The screen point at `length_m` along the ray; everything is divided by the length, so that infinity is a number like any other.
real3 screen_point(real3 position, real3 direction, real length_m)
{
    real2 to_px = real2(focal_px.x, -focal_px.y);
    if (orthographic != 0)
    {
        real3 end = position + length_m * direction;
        return real3(centre_px + to_px * end.xy, (far_m + end.z) / (far_m - near_m));
    }
    real  inverse_length = real(1) / length_m;
    real3 end            = position * inverse_length + direction;
    return real3(centre_px + to_px * (end.xy / -end.z), near_m * inverse_length / -end.z);
}

Segment make_segment(ivec2 pixel, real depth, real3 normal)
{
    real2 centre    = real2(pixel) + real(0.5);
    real2 slope     = px_to_slope(centre);
    real  distance_m = depth_to_distance(depth);
    real3 position  = real3(orthographic == 0 ? slope * distance_m : slope, -distance_m);
    real3 view      = orthographic == 0 ? normalize(real3(slope, -1)) : real3(0, 0, -1);
    real3 direction = normalize(view - real(2) * dot(normal, view) * normal);

    int  side;
    real length_m = clip_length(position, direction, side);
    Segment segment;
    segment.origin     = real3(centre, depth);
    segment.delta      = real3(0);
    segment.length_m   = length_m;
    segment.end_status = side == SIDE_MAX_DISTANCE ? TRACE_PAST_MAX_DISTANCE : TRACE_LEFT_SCREEN;
    if (length_m <= ray_offset_m || length_m <= real(0)) return segment;

    real3 end = screen_point(position, direction, length_m);
    end.xy    = clamp(end.xy, real2(0), real2(size_px));
    if (side == SIDE_LEFT) end.x = real(0);
    if (side == SIDE_RIGHT) end.x = real(size_px.x);
    if (side == SIDE_TOP) end.y = real(0);
    if (side == SIDE_BOTTOM) end.y = real(size_px.y);
    if (ray_offset_m > real(0))
    {
        segment.origin = screen_point(position, direction, ray_offset_m);
        segment.length_m -= ray_offset_m;
    }
    segment.delta = end - segment.origin;
    return segment;
}

bool reflects(ivec2 pixel, out real depth, out real3 normal)
{
    depth        = real(imageLoad(depth_image, pixel).x);
    vec3  stored = imageLoad(normal_image, pixel).xyz;
    float largest = max(max(abs(stored.x), abs(stored.y)), abs(stored.z));
    // Scaled by its largest component first: squares of very small or large numbers leave the range of float.
    real3 scaled = real3(stored) / real(largest > 0.0 ? largest : 1.0);
    normal       = normalize(scaled);
    bool finite  = largest > 0.0 && !any(isnan(stored)) && !any(isinf(stored));
    return depth > real(0) && finite && imageLoad(material_image, pixel).a > 0.0;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    real  depth;
    real3 normal;
    bool  traced = all(lessThan(pixel, size_px));
    traced       = traced && reflects(pixel, depth, normal);

    uvec4 ballot = subgroupBallot(traced);
    uint  first  = 0;
    if (subgroupElect()) first = atomicAdd(ray_count, subgroupBallotBitCount(ballot));
    first = subgroupBroadcastFirst(first);
    if (!traced) return;

    uint    index       = first + subgroupBallotExclusiveBitCount(ballot);
    Segment segment     = make_segment(pixel, depth, normal);
    ray_origin[index]   = segment.origin;
    ray_delta[index]    = segment.delta;
    ray_length_m[index] = segment.length_m;
    ray_pixel[index]    = pack_pixel(pixel, segment.end_status);
}
