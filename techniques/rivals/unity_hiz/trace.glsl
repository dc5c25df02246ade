// Written from the description, in its own terms: a cell has two walls ahead of the ray, and below it a floor (its nearest depth) and a base (the back of
// that depth's slab; HDRP's is relative to the distance). Without HDRP's bias of the ray's origin: here every technique gets the same ray.
#include "api/sampling.glsl"
#include "structures/depth_pyramid/front.glsl"

TraceResult trace(Ray ray)
{
    const real bias_px = real(1) / real(2048);
    real3 inverse = real3(ray.delta.x != real(0) ? real(1) / ray.delta.x : real(1e30), ray.delta.y != real(0) ? real(1) / ray.delta.y : real(1e30),
                          ray.delta.z != real(0) ? real(1) / ray.delta.z : real(1e30));
    ivec2 forward    = ivec2(greaterThanEqual(inverse.xy, real2(0)));
    real2 direction  = real2(2 * forward - 1);
    bool  toward_eye = inverse.z >= real(0);
    int   top = pyramid_top(), level = 0, visited = 0;
    // From the pixel's centre to the first border.
    real  t   = min(abs(inverse.x), abs(inverse.y)) / real(2), t_in = t;
    ivec2 pixel = ray.start_pixel;
    bool  hit = false, missed = false, was_below = false;
    while (!hit && !missed && t <= real(1) && visited < max_steps)
    {
        t_in = t;
        // A place near a border counts as across it.
        real3 position = ray.origin + t * ray.delta;
        real2 to_border = direction * (round(position.xy) - position.xy) + bias_px;
        pixel = clamp(ivec2(position.xy + direction * clamp(to_border, real2(0), real2(bias_px))), ivec2(0), size_px - 1);

        int   on_level  = level;
        real  ground    = fetch_front(pixel, on_level);
        real2 walls     = (real2(((pixel >> on_level) + forward) << on_level) - ray.origin.xy) * inverse.xy;
        real  t_wall    = min(walls.x, walls.y), t_ground = (ground - ray.origin.z) * inverse.z;
        bool  below     = position.z < ground;
        bool  inside    = below && position.z >= slab_back(ground);
        bool  reaches   = t <= t_ground && t_ground <= t_wall;
        bool  leaf      = on_level == 0;
        missed    = was_below && inside;
        hit       = leaf && !missed && (reaches || inside);
        was_below = leaf && below;
        t         = reaches ? t_ground : !leaf && below ? t : t_wall;
        level     = clamp(on_level + (reaches || below || toward_eye ? -1 : 1), 0, top);
        t         = hit && !reaches ? t_in : t;
        ++visited;
    }
    bool found = hit && t <= real(1) && pixel != ray.start_pixel;
    if (found) return hit_at(ray, test_pixel(ray, pixel, t_in, t), t, visited);
    return hit || missed || t > real(1) ? miss(ray, visited) : out_of_steps(visited);
}
