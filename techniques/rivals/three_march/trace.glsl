// Written from the description, in its own terms.
#include "api/directions.glsl"
#include "api/sampling.glsl"

// Is the surface of a pixel, at this place in it, close to the ray's line and does it face the ray?
bool is_met(Ray ray, ivec2 pixel, real2 position_px, real surface)
{
    real3 point_vs     = px_to_vs(real3(position_px, surface)), direction = normalize(direction_vs(ray));
    real  from_line_m  = length(cross(point_vs - px_to_vs(ray.origin), direction));
    real  pixel_m      = px_to_vs(real3(position_px + real2(1, 0), surface)).x - point_vs.x;
    real  thickness_m  = depth_to_distance(slab_back(surface)) - depth_to_distance(surface);
    return from_line_m <= max(thickness_m, real(3) * pixel_m) && dot(direction, fetch_normal(pixel)) < real(0);
}

TraceResult trace(Ray ray)
{
    int  count = max(1, int(max(abs(ray.delta.x), abs(ray.delta.y)) * real(quality))), taken = 0;
    real t     = real(0);
    ivec2 pixel = ray.start_pixel;
    bool  found = false;
    while (!found && taken + 1 < count && taken < max_steps)
    {
        ++taken;
        t            = real(taken) / real(count);
        pixel        = pixel_at(ray, t);
        real surface = fetch_depth(pixel);
        bool behind  = surface > real(0) && depth_at(ray, t) <= surface && pixel != ray.start_pixel;
        if (behind) found = is_met(ray, pixel, ray.origin.xy + t * ray.delta.xy, surface);
    }
    if (found) return TraceResult(TRACE_HIT, pixel, t, taken);
    return taken + 1 < count ? out_of_steps(taken) : miss(ray, taken);
}
