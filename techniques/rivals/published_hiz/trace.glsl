// Written from the description, in its own terms: position.xy in uv, a cell's surface is one plane, the ray advances to the nearest of the
// cell's two borders and that plane. It ends where level 0 is passed downward; a hit if that is within the thickness.
#include "api/box.glsl"
#include "api/depth_interval.glsl"
#include "api/test_pixel.glsl"
#include "structures/depth_pyramid/front.glsl"

TraceResult trace(Ray ray)
{
    real3 origin    = real3(ray.origin.xy / real2(size_px), ray.origin.z);
    real3 direction = real3(ray.delta.xy / real2(size_px), ray.delta.z);
    real3 inverse   = real3(direction.x != real(0) ? real(1) / direction.x : real(1e30), direction.y != real(0) ? real(1) / direction.y : real(1e30),
                            direction.z != real(0) ? real(1) / direction.z : real(1e30));
    real2 pixel_uv  = real(1) / real2(size_px);
    real2 uv_offset = real2(0.005) / real2(size_px) * real2(direction.x < real(0) ? -1 : 1, direction.y < real(0) ? -1 : 1);
    real2 floor_offset = real2(direction.x < real(0) ? 0 : 1, direction.y < real(0) ? 0 : 1);

    // Out of the pixel that it starts from.
    real2 t_axis = ((floor(origin.xy * real2(size_px)) + floor_offset) / real2(size_px) + uv_offset - origin.xy) * inverse.xy;
    real  t_start = min(t_axis.x, t_axis.y), t = t_start;
    int   top = pyramid_top(), level = 0, visited = 0;
    real3 position = origin + t * direction;
    while (level >= 0 && t < real(1) && visited < max_steps)
    {
        int   on_level  = level;
        ivec2 under     = clamp(ivec2(floor(position.xy * real2(size_px))), ivec2(0), size_px - 1);
        real  surface   = fetch_front(under, on_level);
        real2 border    = (real2(under >> on_level) + floor_offset) * (real(1 << on_level) * pixel_uv) + uv_offset;
        real2 t_border  = border * inverse.xy - origin.xy * inverse.xy;
        real  t_leave   = min(t_border.x, t_border.y);
        // Depth is larger where it is nearer: a ray that comes nearer never meets the plane from the front.
        real  t_surface = direction.z < real(0) ? (surface - origin.z) * inverse.z : real(2);
        bool  in_front  = position.z > surface;
        bool  skipped   = in_front && t_leave < t_surface;
        t        = in_front ? min(t_leave, t_surface) : t;
        position = origin + t * direction;
        level    = skipped ? min(level + 1, top) : level - 1;
        ++visited;
    }
    if (level >= 0) return t < real(1) ? out_of_steps(visited) : miss(ray, visited);
    ivec2 pixel = clamp(ivec2(floor(ray.origin.xy + t * ray.delta.xy)), ivec2(0), size_px - 1);
    uvec2 words = fetch_pixel(pixel);
    real  depth = real(depth_in(words, pixel));
    bool touched = interval_touches(depth, depth_interval(ray, position.z, min(position.z, depth)));
    bool ends = t <= real(1) && pixel != ray.start_pixel && ends_at(ray, surface_at(ray, pixel, 0, words), touched, t);
    if (ends) return hit_at(ray, Contact(true, pixel, 0, words, t, t, false), t, visited);
    return miss(ray, visited);
}
