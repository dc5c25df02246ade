// Written from the description, in its own terms. Godot's levels are rounded down and found by uv; these are found by pixel, and say the same at level 0.
#include "api/directions.glsl"
#include "api/sampling.glsl"
#include "structures/depth_pyramid/front.glsl"

real inverse_of(real x) { return x != real(0) ? real(1) / x : real(1e30); }

// Is the surface of a pixel within the thickness of a point on the same line of sight, before it or behind it?
bool is_near(real3 position, real surface)
{
    real surface_m   = depth_to_distance(surface);
    real thickness_m = depth_to_distance(slab_back(surface)) - surface_m;
    real per_metre   = orthographic == 0 ? length(real3(px_to_slope(position.xy), 1)) : real(1);
    return abs(depth_to_distance(position.z) - surface_m) * per_metre < thickness_m;
}

TraceResult trace(Ray ray)
{
    real3 inverse    = real3(inverse_of(ray.delta.x), inverse_of(ray.delta.y), inverse_of(ray.delta.z));
    ivec2 ahead      = ivec2(greaterThanEqual(ray.delta.xy, real2(0)));
    real2 across     = real2(2 * ahead - 1) * real(1e-6) * real2(size_px);
    bool  toward_eye = ray.delta.z >= real(0);

    real2 t_wall = (real2(ray.start_pixel + ahead) + across - ray.origin.xy) * inverse.xy;
    real  t      = min(t_wall.x, t_wall.y);
    int   top = pyramid_top(), level = 0, visited = 0;
    while (level >= 0 && t < real(1) && visited < max_steps)
    {
        ++visited;
        int   on_level = level;
        ivec2 pixel    = pixel_at(ray, t);
        real  front    = fetch_front(pixel, on_level), t_front = (front - ray.origin.z) * inverse.z;
        t_wall         = (real2(((pixel >> on_level) + ahead) << on_level) + across - ray.origin.xy) * inverse.xy;
        real  t_leave  = min(t_wall.x, t_wall.y);
        bool  too_deep = on_level == 0 && front > real(0) && depth_at(ray, t) < slab_back(front);
        bool  meets    = !too_deep && (toward_eye ? t <= t_front : t_front <= t_leave);
        t     = !meets ? t_leave : toward_eye ? t : max(t, t_front);
        level = meets ? on_level - 1 : too_deep ? 0 : min(on_level + 1, top);
    }
    if (level >= 0 && t < real(1)) return out_of_steps(visited);
    if (t >= real(1)) return miss(ray, visited);

    ivec2 pixel   = pixel_at(ray, t);
    real  surface = fetch_depth(pixel);
    bool  at_once = all(lessThan(abs(t * ray.delta.xy), real2(2)));
    bool  leaves  = at_once && dot(direction_vs(ray), fetch_normal(pixel)) >= real(0);
    bool  found   = surface > real(0) && !leaves && pixel != ray.start_pixel && is_near(ray.origin + t * ray.delta, surface);
    return found ? TraceResult(TRACE_HIT, pixel, t, visited) : miss(ray, visited);
}
