// Written from the description, in its own terms: the time of a sample is in pixels along the longer axis. The far plane is infinitely far.
#include "api/directions.glsl"
#include "api/sampling.glsl"

// The pattern of the first frame, of which later ones are shifts.
real gradient_noise(real2 position_px)
{
    real2 seeded = position_px + real(5) * real(0.695) * real2(47, 17);
    return fract(real(52.9829189) * fract(dot(seeded, real2(0.06711056, 0.00583715))));
}

real distance_to_depth(real distance_m) { return orthographic == 0 ? near_m / distance_m : (far_m - distance_m) / (far_m - near_m); }

// How much farther the thickness makes the ray's depth: x at its start, y more for each pixel along the longer axis.
real2 thickness_in_depth(Ray ray, real length_px)
{
    real t_1000_m  = isinf(ray.length_m) ? real(1) : fraction_to_t(ray, real(1000) / ray.length_m);
    real t_near    = ray.delta.z > real(0) ? (real(1) - ray.origin.z) / ray.delta.z : real(1e30);
    real t_end     = min(t_1000_m > real(0) ? t_1000_m : real(1e30), t_near);
    real distance_m = depth_to_distance(ray.origin.z), after_1_m = distance_m - normalize(direction_vs(ray)).z;
    real back      = slab_back(ray.origin.z), back_after_1_m = slab_back(distance_to_depth(after_1_m));
    return real2(back - ray.origin.z, (back_after_1_m - back) / (t_end * length_px) - ray.delta.z / length_px);
}

TraceResult trace(Ray ray)
{
    real length_px = max(abs(ray.delta.x), abs(ray.delta.y));
    if (length_px < real(1.1)) return miss(ray, 0);

    const real bias = real(2.4e-7);
    real2 thickness = thickness_in_depth(ray, length_px);
    real  random    = gradient_noise(real2(ray.start_pixel)), growth = real(1) - real(0.95) * real(quality);
    real  reached_px = real(1.001), time_px = real(1.001), time_before_px = time_px, above = bias, above_before = above;
    bool  ends      = false;
    int   taken     = 0;
    while (!ends && time_px < length_px && taken < max_steps)
    {
        ++taken;
        real stride_px = real(1) + real(taken) * growth;
        time_before_px = time_px;
        above_before   = above;
        time_px        = min(reached_px + stride_px * random, length_px);
        reached_px += stride_px;
        ivec2 pixel    = pixel_at(ray, time_px / length_px);
        above          = depth_at(ray, time_px / length_px) + bias - max(fetch_depth(pixel), real(0));
        bool  is_near  = above > thickness.x + time_px * thickness.y || abs(above) < abs(ray.delta.z / length_px * stride_px * real(2));
        ends           = above < real(0) && is_near && pixel != ray.start_pixel;
    }
    if (!ends) return time_px < length_px ? out_of_steps(taken) : miss(ray, taken);
    if (above_before < real(0)) return miss(ray, taken); // from behind

    real  t     = mix(time_before_px, time_px, clamp(above_before / (above_before - above), real(0), real(1))) / length_px;
    ivec2 pixel = pixel_at(ray, t);
    bool  found = fetch_depth(pixel) > real(0) && pixel != ray.start_pixel;
    return found ? TraceResult(TRACE_HIT, pixel, t, taken) : miss(ray, taken);
}
