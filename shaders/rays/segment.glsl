// A ray in screen space: the segment from a pixel's surface, clipped to the near plane, the image and the maximum distance
// (docs/reference/hit_contract.md). Set up in double-floats (df64): its ends are the nearest floats to those of exact numbers, nearly always.
#include "api/view.glsl"
#include "rays/double_float.glsl"
#include "layout/frame_shared.h"
#include "layout/normal_image.glsl"
#include "rays/ray_offset.glsl"
#include "layout/packed_ray.glsl"

struct Segment
{
    real3 origin; // x_px, y_px, depth
    real3 delta;
    real  length_m;
    int   end_status;
};

// The normal of a pixel in view space, times a power of two that keeps squares within the range of float.
real3 normal_at(ivec2 pixel)
{
    vec3  stored   = imageLoad(normal_image, pixel).xyz;
    float largest  = max(max(abs(stored.x), abs(stored.y)), abs(stored.z));
    int   exponent = floatBitsToInt(largest) >> 23;
    return real3(stored * intBitsToFloat(clamp(254 - exponent, 1, 253) << 23));
}

// The direction (x, y, -1) of the view ray through a position, or the view axis.
Df64x3 view_direction(real2 position_px)
{
    if (orthographic != 0) return to_df64(real3(0, 0, -1));
    df64 x = quotient(sum(to_df64(position_px.x), -to_df64(centre_px.x, centre_low_px.x)), to_df64(focal_px.x, focal_low_px.x));
    df64 y = quotient(sum(to_df64(position_px.y), -to_df64(centre_px.y, centre_low_px.y)), to_df64(focal_px.y, focal_low_px.y));
    return Df64x3(x, -y, to_df64(real(-1)));
}

// Mirror direction, |normal|^2 times as long as `view`.
Df64x3 mirrored(Df64x3 view, real3 normal)
{
    Df64x3 n      = to_df64(normal);
    df64   cosine = inner_product(n, view);
    return sum(scaled(inner_product(n, n), view), scaled(-(cosine + cosine), n));
}

// ---- On screen a ray of direction r from the point that is seen along the slope s at a depth moves along
//   D = (focal.x (r.x + s.x r.z), -focal.y (r.y + s.y r.z), depth r.z)    orthographic: (focal.x r.x, -focal.y r.y, r.z / (far - near))
// and stands after lambda r at O + k D with k = 1 / (distance / lambda - r.z), orthographic: lambda. No difference of two projected points is
// taken, infinity is a length like any other, and mirrored rays have exactly mirrored segments.
Df64x3 screen_rate(real2 start_px, real depth, Df64x3 direction)
{
    Df64x3 slope = view_direction(start_px);
    df64   x = direction.x, y = direction.y, z = quotient(direction.z, to_df64(far_m - near_m));
    if (orthographic == 0)
    {
        x = sum(x, product(slope.x, direction.z));
        y = sum(y, product(slope.y, direction.z));
        z = product(to_df64(depth), direction.z);
    }
    return Df64x3(product(to_df64(focal_px.x, focal_low_px.x), x), -product(to_df64(focal_px.y, focal_low_px.y), y), z);
}

#define SIDE_MAX_DISTANCE 0
#define SIDE_FAR 1
#define SIDE_NEAR 2
#define SIDE_LEFT 3
#define SIDE_RIGHT 4
#define SIDE_TOP 5
#define SIDE_BOTTOM 6

// k = distance / rate. A ray that never gets there has a rate of at most 0.
struct Limit
{
    int  side;
    df64 distance, rate;
};

real limit_k(Limit limit)
{
    return to_real(limit.rate) > real(0) ? max(to_real(limit.distance), real(0)) / to_real(limit.rate) : real(uintBitsToFloat(0x7F800000u)); // infinity
}

Limit nearer(Limit a, Limit b)
{
    if (limit_k(b) < limit_k(a)) return b;
    return a;
}

real size_of(Df64x3 v)
{
    real3        a      = to_real(v);
    precise real square = a.x * a.x + a.y * a.y + a.z * a.z;
    return sqrt(square);
}

// After so many metres. A direction's `size` is its length.
Limit at_distance(real metres, real distance_m, Df64x3 direction, real size)
{
    if (orthographic != 0) return Limit(SIDE_MAX_DISTANCE, to_df64(metres), to_df64(size));
    // By the larger of the two lengths, so that 0 and infinity are lengths like any other.
    bool         far      = metres > distance_m;
    real         distance = far ? real(1) : metres / distance_m;
    precise real rate     = size * (far ? distance_m / metres : real(1));
    return Limit(SIDE_MAX_DISTANCE, to_df64(distance), sum(to_df64(rate), -product(to_df64(distance), direction.z)));
}

Segment make_segment(real2 start_px, real depth, Df64x3 direction)
{
    Df64x3 rate       = screen_rate(start_px, depth, direction);
    real   distance_m = depth_to_distance(depth), size = size_of(direction);
    Limit  limit      = at_distance(max_distance_m, distance_m, direction, size);
    limit             = nearer(limit, Limit(SIDE_NEAR, sum(to_df64(real(1)), -to_df64(depth)), rate.z));
    if (orthographic != 0) limit = nearer(limit, Limit(SIDE_FAR, to_df64(depth), -rate.z));
    limit = nearer(limit, Limit(SIDE_LEFT, to_df64(start_px.x), -rate.x));
    limit = nearer(limit, Limit(SIDE_RIGHT, to_df64(real(size_px.x) - start_px.x), rate.x));
    limit = nearer(limit, Limit(SIDE_TOP, to_df64(start_px.y), -rate.y));
    limit = nearer(limit, Limit(SIDE_BOTTOM, to_df64(real(size_px.y) - start_px.y), rate.y));

    Segment segment;
    segment.origin     = real3(start_px, depth);
    segment.delta      = real3(0);
    segment.length_m   = real(0);
    segment.end_status = limit.side <= SIDE_FAR ? TRACE_PAST_MAX_DISTANCE : TRACE_LEFT_SCREEN;
    if (!(limit_k(limit) > real(0)) || isinf(limit_k(limit))) return segment;

    df64         k           = quotient(limit.distance, limit.rate);
    Df64x3       whole_delta = scaled(k, rate);
    precise real far         = size * to_real(k);
    if (orthographic == 0) far = far * near_m / to_real(sum(to_df64(depth), whole_delta.z));
    segment.length_m = limit.side == SIDE_MAX_DISTANCE ? max_distance_m : far;
    if (segment.length_m <= ray_offset_m) return segment;

    if (ray_offset_m > real(0))
    {
        Limit start       = at_distance(ray_offset_m, distance_m, direction, size);
        df64  start_k     = quotient(start.distance, start.rate);
        segment.origin    = to_real(sum(to_df64(segment.origin), scaled(start_k, rate)));
        segment.origin.xy = clamp(segment.origin.xy, real2(0), real2(size_px));
        segment.length_m -= ray_offset_m;
        whole_delta = scaled(sum(k, -start_k), rate);
    }
    // The end lies exactly on the border that limits the ray, and inside the image on the other axis.
    real2 low = -segment.origin.xy, high = real2(size_px) - segment.origin.xy;
    real3 delta = to_real(whole_delta);
    delta.xy    = clamp(delta.xy, low, high);
    if (limit.side == SIDE_LEFT) delta.x = low.x;
    if (limit.side == SIDE_RIGHT) delta.x = high.x;
    if (limit.side == SIDE_TOP) delta.y = low.y;
    if (limit.side == SIDE_BOTTOM) delta.y = high.y;
    segment.delta = delta;
    return segment;
}

PackedRay segment_to_packed_ray(Segment segment, ivec2 pixel)
{
    return PackedRay(segment.origin, segment.length_m, segment.delta, pack_pixel(pixel, segment.end_status));
}
