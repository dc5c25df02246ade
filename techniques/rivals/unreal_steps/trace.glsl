// Written from the description, in its own terms.
#include "api/directions.glsl"
#include "api/sampling.glsl"

real gradient_noise(real2 position_px) { return fract(real(52.9829189) * fract(dot(position_px, real2(0.06711056, 0.00583715)))); }

// Half the depth behind a surface in which a sample hits it.
real tolerance_of(Ray ray)
{
    // The depth as far behind the start as that is from the eye; a ray toward the eye ends before it.
    real distance_m = depth_to_distance(ray.origin.z), toward = normalize(direction_vs(ray)).z;
    real deeper_m   = distance_m * (real(1) + min(toward > real(0) ? real(0.95) / toward : real(1), real(1)));
    real deeper     = orthographic == 0 ? near_m / deeper_m : (far_m - deeper_m) / (far_m - near_m);
    return max(orthographic == 0 ? abs(ray.delta.z) : real(0), real(4) * (ray.origin.z - deeper)) / real(steps);
}

TraceResult trace(Ray ray)
{
    real  start = gradient_noise(real2(ray.start_pixel) + real(0.5)) - real(0.5), tolerance = tolerance_of(ray);
    real  above = real(0), above_before = real(0);
    bool  ends  = false;
    int   taken = 0;
    while (!ends && taken < steps)
    {
        ++taken;
        above_before = above;
        real  t      = (real(taken) + start) / real(steps);
        ivec2 pixel  = pixel_at(ray, t);
        real surface = fetch_farthest(pixel);
        above        = depth_at(ray, t) - surface;
        ends         = t <= real(1) && surface > real(0) && abs(above + tolerance) < tolerance;
    }
    if (!ends) return miss(ray, taken);
    real share  = clamp(above_before / (above_before - above), real(0), real(1));
    real t      = max((real(taken - 1) + share + start) / real(steps), real(0));
    ivec2 pixel = pixel_at(ray, t);
    bool  found = pixel != ray.start_pixel && fetch_depth(pixel) > real(0);
    return found ? TraceResult(TRACE_HIT, pixel, t, taken) : miss(ray, taken);
}
