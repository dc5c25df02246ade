// A ray in screen space: the segment from a pixel's surface, clipped to the near plane, the image and the maximum distance
// (docs/hit_contract.md).
#include "view.glsl"
#include "reflecting.glsl"

layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1;
layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0;

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

// The ray from the surface seen at start_px; position: that point in view space.
Segment make_segment(real2 start_px, real depth, real3 position, real3 direction)
{
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
