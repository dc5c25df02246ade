// Written from the description, in its own terms.
#include "api/box.glsl"
#include "api/sampling.glsl"

real gradient_noise(real2 position_px) { return fract(real(52.9829189) * fract(dot(position_px, real2(0.06711056, 0.00583715)))); }

TraceResult trace(Ray ray)
{
    real  dt    = real(stride_px) / max(max(abs(ray.delta.x), abs(ray.delta.y)), real(0.01));
    real  start = gradient_noise(real2(ray.start_pixel) + real(0.5)), t = start * dt, z_before = ray.origin.z;
    ivec2 pixel = ray.start_pixel;
    bool  found = false;
    int   taken = 0;
    while (!found && t <= real(1) && taken < max_steps)
    {
        pixel        = pixel_at(ray, t);
        real z_after = depth_at(ray, t + dt / real(2)), surface = fetch_depth(pixel);
        bool touches = surface > real(0) && interval_touches(surface, real2(min(z_before, z_after), max(z_before, z_after)));
        found        = touches && pixel != ray.start_pixel;
        z_before     = z_after;
        ++taken;
        t            = (real(taken) + start) * dt;
    }
    if (!found) return t > real(1) ? miss(ray, taken) : out_of_steps(taken);
    t     = beyond ? min(t, real(1)) : t - dt;
    pixel = pixel_at(ray, t);
    bool has_surface = !beyond || fetch_depth(pixel) > real(0);
    return has_surface && pixel != ray.start_pixel ? TraceResult(TRACE_HIT, pixel, t, taken) : miss(ray, taken);
}
