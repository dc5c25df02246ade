// Written from the description, in its own terms.
#include "api/box.glsl"
#include "api/sampling.glsl"

TraceResult trace(Ray ray)
{
    real  dt     = real(stride_px) / max(max(abs(ray.delta.x), abs(ray.delta.y)), real(0.01));
    real  start  = fract(real(ray.start_pixel.x + ray.start_pixel.y + 1) / real(4));
    real  t      = start * dt, z_before = ray.origin.z;
    ivec2 pixel  = ray.start_pixel;
    bool  found  = false, at_sky = false;
    int   taken  = 0;
    while (!found && !at_sky && t <= real(1) && taken < max_steps)
    {
        t     = (real(taken) + start) * dt;
        pixel = pixel_at(ray, t);
        real z_after = depth_at(ray, min(t + dt / real(2), real(1))), surface = fetch_depth(pixel);
        bool touches = surface > real(0) && interval_touches(surface, real2(min(z_before, z_after), max(z_before, z_after)));
        found        = touches && taken > 0 && t <= real(1) && pixel != ray.start_pixel;
        at_sky       = ends_at_sky && taken > 0 && surface <= real(0);
        z_before     = z_after;
        ++taken;
    }
    if (found) return TraceResult(TRACE_HIT, pixel, t, taken);
    return at_sky || t > real(1) ? miss(ray, taken) : out_of_steps(taken);
}
