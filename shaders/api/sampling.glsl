// For techniques that look at samples of a ray: places on it, and the hit test between two t or at one.
#include "api/test_pixel.glsl"

// The pixel that contains the ray at t.
ivec2 pixel_at(Ray ray, real t)
{
    real2 position_px = ray.origin.xy + t * ray.delta.xy;
    return clamp(ivec2(floor(position_px)), ivec2(0), size_px - 1);
}

// Screen t of the point at a fraction of the segment's length in view space (1/distance is linear on screen).
real fraction_to_t(Ray ray, real fraction)
{
    if (orthographic != 0) return fraction;
    real end_depth = ray.origin.z + ray.delta.z;
    return fraction * ray.origin.z / (end_depth - fraction * ray.delta.z);
}

// Screen t of the point so many metres along the ray; above 1 beyond the end of the segment. Infinity is beyond every end.
real metres_to_t(Ray ray, real distance_m)
{
    real fraction = distance_m / ray.length_m;
    return isinf(distance_m) || fraction > real(1) ? real(2) : fraction_to_t(ray, fraction);
}

// Screen t of a stride, in pixels along the longer axis; a shorter ray takes one stride.
real stride_to_t(Ray ray, real stride_px) { return stride_px / max(stride_px, max(abs(ray.delta.x), abs(ray.delta.y))); }

// Screen t where the ray leaves its start pixel, at most 1. A step begins there: before, the ray lies on its own plane.
real start_pixel_end_t(Ray ray)
{
    real2 ahead_px = real2(ray.start_pixel) + real2(greaterThan(ray.delta.xy, real2(0))) - ray.origin.xy;
    real  t_x      = ray.delta.x == real(0) ? real(1) : ahead_px.x / ray.delta.x;
    real  t_y      = ray.delta.y == real(0) ? real(1) : ahead_px.y / ray.delta.y;
    return clamp(min(t_x, t_y), real(0), real(1));
}

// Depth of a pixel, BACKGROUND_DEPTH where there is nothing; counted.
real fetch_depth(ivec2 pixel) { return real(depth_in(fetch_pixel(pixel), pixel)); }

Contact test_interval(Ray ray, ivec2 pixel, real t_in, real t_out, bool sampled)
{
    note_interval(t_in, t_out);
    Contact      contact = Contact(false, pixel, 0, fetch_pixel(pixel), t_in, t_out, sampled);
    PixelSurface surface = surface_of(ray, contact);
    contact.found        = ends_at(ray, surface, meets(ray, surface, t_in, t_out), t_in);
    return first_of_layers(ray, contact);
}

// The hit test: where does the ray end in this pixel, between two t?
Contact test_pixel(Ray ray, ivec2 pixel, real t_in, real t_out) { return test_interval(ray, pixel, t_in, t_out, false); }

// The same by one sample, at t. There a plane has the thickness of the run.
Contact test_sample(Ray ray, ivec2 pixel, real t) { return test_interval(ray, pixel, t, t, true); }
