#include "api/directions.glsl"
#include "api/sampling.glsl"
#include "api/span.glsl"
#include "api/random.glsl"

struct Look
{
    real depth;   // of the surface seen there; none: <= 0
    bool aligned; // it lies in the ray's direction
    bool too_far; // it rises more from the reflector than the ray does: the ray has passed behind it
};

Look look_at(Ray ray, real t, real3 direction, real3 up)
{
    ivec2 pixel  = pixel_at(ray, t);
    real  depth  = fetch_depth(pixel);
    real3 toward = normalize(direction_to_vs(ray, ray.origin.xy + t * ray.delta.xy, depth));
    real  needed = fetch_normal(pixel).y < real(0) ? real(min_alignment_down) : real(min_alignment);
    bool  seen   = depth > real(0);
    return Look(depth, seen && pixel != ray.start_pixel && dot(toward, direction) >= needed, seen && dot(toward, up) > dot(direction, up));
}

TraceResult trace(Ray ray)
{
    Grid  grid = make_grid(ray);
    real  dt = stride_to_t(ray, real(stride_px)), first = real(1) - real(jitter) * random_of(ray.start_pixel);
    real3 direction = normalize(direction_vs(ray)), up = fetch_normal(ray.start_pixel);
    up *= sign(dot(up, direction)); // the reflector's normal on the ray's side
    real  t = first * dt, t_behind = real(0);
    Contact contact = no_contact();
    bool    searching = false;
    int     taken = 0, strides = 0;
    while (!contact.found && t <= real(1) && taken < max_steps)
    {
        bool behind = false;
        while (!behind && t <= real(1) && taken < max_steps)
        {
            Look look = look_at(ray, t, direction, up);
            behind    = look.aligned && depth_at(ray, t) <= look.depth;
            t_behind  = t;
            t         = (real(++strides) + first) * dt;
            ++taken;
        }

        // The search forgets no place that is known to be behind the surface: it ends there.
        real t_search = t_behind, jump = real(0.5) * dt;
        bool too_far  = true;
        int  steps_left = behind ? binary_steps : 0;
        while (steps_left > 0 && taken < max_steps)
        {
            t_search  = clamp(t_search + (too_far ? -jump : jump), real(0), real(1));
            Look look = look_at(ray, t_search, direction, up);
            too_far   = look.too_far;
            t_behind  = too_far && look.aligned ? t_search : t_behind;
            jump     *= real(0.5);
            --steps_left;
            ++taken;
        }

        searching   = steps_left > 0;
        ivec2 pixel = pixel_at(ray, t_behind);
        real2 span  = span_in_pixel(ray, grid, pixel);
        if (behind && !searching) contact = test_pixel(ray, pixel, span.x, span.y);
    }
    if (contact.found) return hit(ray, contact, taken);
    return searching || t <= real(1) ? out_of_steps(taken) : miss(ray, taken);
}
