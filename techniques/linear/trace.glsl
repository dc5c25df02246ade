#include "api/sampling.glsl"
#include "api/span.glsl"

// Screen t of sample i; > 1 beyond the end of the segment.
real sample_t(Ray ray, int i)
{
    if (space == space_pixels) return real(i) * stride_to_t(ray, real(stride_px));
    real fraction = real(i) / real(steps);
    return space == space_screen ? fraction : metres_to_t(ray, max_distance_m * fraction);
}

TraceResult trace(Ray ray)
{
    real    t_begin = start_pixel_end_t(ray), t_before = t_begin, t = real(0);
    Contact contact = no_contact();
    bool    ended = false;
    int     taken = 0;
    while (!ended && !contact.found && taken < steps)
    {
        ++taken;
        t_before    = max(t, t_begin);
        t           = sample_t(ray, taken);
        ended       = t > real(1);
        ivec2 pixel = pixel_at(ray, t);
        bool  tests = !ended && pixel != ray.start_pixel;
        if (tests && interval) contact = test_pixel(ray, pixel, t_before, t);
        if (tests && !interval) contact = test_sample(ray, pixel, t);
    }
    if (!contact.found) return space == space_pixels && !ended && sample_t(ray, taken + 1) <= real(1) ? out_of_steps(taken) : miss(ray, taken);
    if (!interpolate || ray.delta.z == real(0)) return hit_at(ray, contact, t, taken);

    ivec2 front = pixel_at(ray, clamp((fetch_depth(contact.pixel) - ray.origin.z) / ray.delta.z, t_before, t));
    real2 span  = span_in_pixel(ray, make_grid(ray), front);
    Contact moved = no_contact();
    if (front != ray.start_pixel) moved = test_pixel(ray, front, span.x, span.y);
    if (moved.found) return hit(ray, moved, taken);
    return hit_at(ray, contact, t, taken);
}
