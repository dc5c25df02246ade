// A ray in screen space: the segment from a pixel's surface, clipped to the near plane, the image and the maximum distance
// (docs/hit_contract.md). Set up in wide numbers: its ends are the nearest floats to those of exact numbers, nearly always.
#include "api/view.glsl"
#include "rays/double_float.glsl"
#include "rays/reflecting.glsl"
#include "layout/packed_ray.glsl"

layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1;
layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0;

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
Wide3 view_direction(real2 position_px)
{
    if (orthographic != 0) return widen(real3(0, 0, -1));
    wide x = quotient(sum(widen(position_px.x), -widen(centre_px.x, centre_low_px.x)), widen(focal_px.x, focal_low_px.x));
    wide y = quotient(sum(widen(position_px.y), -widen(centre_px.y, centre_low_px.y)), widen(focal_px.y, focal_low_px.y));
    return Wide3(x, -y, widen(real(-1)));
}

// Mirror direction, |normal|^2 times as long as `view`.
Wide3 mirrored(Wide3 view, real3 normal)
{
    Wide3 n      = widen(normal);
    wide  cosine = inner_product(n, view);
    return sum(scaled(inner_product(n, n), view), scaled(-(cosine + cosine), n));
}

// ---- On screen a ray of direction r from the point that is seen along the slope s at a depth moves along
//   D = (focal.x (r.x + s.x r.z), -focal.y (r.y + s.y r.z), depth r.z)    orthographic: (focal.x r.x, -focal.y r.y, r.z / (far - near))
// and stands after lambda r at O + k D with k = 1 / (distance / lambda - r.z), orthographic: lambda. No difference of two projected points is
// taken, infinity is a length like any other, and mirrored rays have exactly mirrored segments.
Wide3 screen_rate(real2 start_px, real depth, Wide3 direction)
{
    Wide3 slope = view_direction(start_px);
    wide  x = direction.x, y = direction.y, z = quotient(direction.z, widen(far_m - near_m));
    if (orthographic == 0)
    {
        x = sum(x, product(slope.x, direction.z));
        y = sum(y, product(slope.y, direction.z));
        z = product(widen(depth), direction.z);
    }
    return Wide3(product(widen(focal_px.x, focal_low_px.x), x), -product(widen(focal_px.y, focal_low_px.y), y), z);
}

#define SIDE_MAX_DISTANCE 0
#define SIDE_FAR 1
#define SIDE_NEAR 2
#define SIDE_LEFT 3
#define SIDE_RIGHT 4
#define SIDE_TOP 5
#define SIDE_BOTTOM 6

// k = room / rate. A ray that never gets there has a rate of at most 0.
struct Limit
{
    int  side;
    wide room, rate;
};

real limit_k(Limit limit)
{
    return narrow(limit.rate) > real(0) ? max(narrow(limit.room), real(0)) / narrow(limit.rate) : real(uintBitsToFloat(0x7F800000u)); // infinity
}

Limit nearer(Limit a, Limit b)
{
    if (limit_k(b) < limit_k(a)) return b;
    return a;
}

real size_of(Wide3 v)
{
    real3        a      = narrow(v);
    precise real square = a.x * a.x + a.y * a.y + a.z * a.z;
    return sqrt(square);
}

// After so many metres. A direction's `size` is its length.
Limit at_distance(real metres, real distance_m, Wide3 direction, real size)
{
    if (orthographic != 0) return Limit(SIDE_MAX_DISTANCE, widen(metres), widen(size));
    // By the larger of the two lengths, so that 0 and infinity are lengths like any other.
    bool         far  = metres > distance_m;
    real         room = far ? real(1) : metres / distance_m;
    precise real rate = size * (far ? distance_m / metres : real(1));
    return Limit(SIDE_MAX_DISTANCE, widen(room), sum(widen(rate), -product(widen(room), direction.z)));
}

Segment make_segment(real2 start_px, real depth, Wide3 direction)
{
    Wide3 rate       = screen_rate(start_px, depth, direction);
    real  distance_m = depth_to_distance(depth), size = size_of(direction);
    Limit limit      = at_distance(max_distance_m, distance_m, direction, size);
    limit            = nearer(limit, Limit(SIDE_NEAR, sum(widen(real(1)), -widen(depth)), rate.z));
    if (orthographic != 0) limit = nearer(limit, Limit(SIDE_FAR, widen(depth), -rate.z));
    limit = nearer(limit, Limit(SIDE_LEFT, widen(start_px.x), -rate.x));
    limit = nearer(limit, Limit(SIDE_RIGHT, widen(real(size_px.x) - start_px.x), rate.x));
    limit = nearer(limit, Limit(SIDE_TOP, widen(start_px.y), -rate.y));
    limit = nearer(limit, Limit(SIDE_BOTTOM, widen(real(size_px.y) - start_px.y), rate.y));

    Segment segment;
    segment.origin     = real3(start_px, depth);
    segment.delta      = real3(0);
    segment.length_m   = real(0);
    segment.end_status = limit.side <= SIDE_FAR ? TRACE_PAST_MAX_DISTANCE : TRACE_LEFT_SCREEN;
    if (!(limit_k(limit) > real(0)) || isinf(limit_k(limit))) return segment;

    wide          k    = quotient(limit.room, limit.rate);
    Wide3         way  = scaled(k, rate);
    precise real  far  = size * narrow(k);
    if (orthographic == 0) far = far * near_m / narrow(sum(widen(depth), way.z));
    segment.length_m = limit.side == SIDE_MAX_DISTANCE ? max_distance_m : far;
    if (segment.length_m <= ray_offset_m) return segment;

    if (ray_offset_m > real(0))
    {
        Limit start       = at_distance(ray_offset_m, distance_m, direction, size);
        wide  start_k     = quotient(start.room, start.rate);
        segment.origin    = narrow(sum(widen(segment.origin), scaled(start_k, rate)));
        segment.origin.xy = clamp(segment.origin.xy, real2(0), real2(size_px));
        segment.length_m -= ray_offset_m;
        way = scaled(sum(k, -start_k), rate);
    }
    // The end lies exactly on the border that limits the ray, and inside the image on the other axis.
    real2 low = -segment.origin.xy, high = real2(size_px) - segment.origin.xy;
    real3 delta = narrow(way);
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
