// Written from the description, in its own terms. A filtered depth counts as four fetches.
#include "api/random.glsl"
#include "api/sampling.glsl"
#include "api/view.glsl"

real texel(ivec2 pixel) { return max(fetch_depth(clamp(pixel, ivec2(0), size_px - 1)), real(0)); }

real filtered_depth(real2 position_px)
{
    real2 place = position_px - real(0.5), share = place - floor(place);
    ivec2 first = ivec2(floor(place));
    real2 left  = real2(texel(first), texel(first + ivec2(0, 1)));
    real2 right = real2(texel(first + ivec2(1, 0)), texel(first + ivec2(1, 1)));
    real2 both  = mix(left, right, share.x);
    return mix(both.x, both.y, share.y);
}

struct Sample
{
    real above_m;  // how far the surface lies behind the ray
    bool is_below; // the ray is behind it
    bool is_near;  // within the thickness
};

real distance_of(real depth) { return depth > real(0) ? depth_to_distance(depth) : real(1e30); }

Sample sample_at(Ray ray, real t)
{
    ivec2 pixel = pixel_at(ray, t);
    real  z = depth_at(ray, t), own = texel(pixel), filtered = filtered_depth(ray.origin.xy + t * ray.delta.xy);
    real  above_m = distance_of(min(own, filtered)) * real(1.000002) - depth_to_distance(z);
    bool  is_near = z > slab_back(max(own, filtered)) && min(own, filtered) > slab_back(z);
    return Sample(above_m, above_m < real(0) && pixel != ray.start_pixel, is_near);
}

TraceResult trace(Ray ray)
{
    int    count   = max(2, min(steps, int(length(ray.delta.xy)))), taken = 0;
    real   start   = random_of(ray.start_pixel), t_above = real(0), above_m = real(0), t = real(0);
    Sample current = Sample(real(0), false, false);
    while (!current.is_below && taken < count)
    {
        t_above = t;
        above_m = current.above_m;
        t       = (real(taken) + start) / real(count);
        current = sample_at(ray, t);
        ++taken;
    }
    if (!current.is_below) return miss(ray, taken);

    for (int k = 0; k < halvings; ++k)
    {
        real   middle = real(0.5) * (t_above + t);
        Sample there  = sample_at(ray, middle);
        t_above = there.is_below ? t_above : middle;
        above_m = there.is_below ? above_m : there.above_m;
        t       = there.is_below ? middle : t;
        if (there.is_below) current = there;
    }
    if (secant)
    {
        real   crossing_t = mix(t_above, t, above_m / (above_m - current.above_m));
        Sample there      = sample_at(ray, crossing_t);
        bool   better     = abs(there.above_m) < real(0.9) * above_m;
        t = better ? crossing_t : t;
        if (better) current = there;
    }
    ivec2 pixel = pixel_at(ray, t);
    bool  found = current.is_near && pixel != ray.start_pixel;
    return found ? TraceResult(TRACE_HIT, pixel, t, taken + halvings) : miss(ray, taken + halvings);
}
