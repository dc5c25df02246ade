// One loop for strides and searches: each turn looks at one place, and the number of search steps left, -1 between searches, says what it
// is part of.
TraceResult trace(Ray ray)
{
    Grid  grid = make_grid(ray);
    real  dt = stride_to_t(ray, real(stride_px)), first = real(1) - real(jitter) * random_of(ray.start_pixel);
    // The reflector's normal, on the ray's side, orders directions: behind a surface that rises more than the ray, the ray has gone too far.
    real3 direction = normalize(direction_vs(ray)), up = fetch_normal(ray.start_pixel);
    up             *= sign(dot(up, direction));
    real  t = first * dt, jump = real(0), t_behind = t, t_in = real(0), t_out = real(0);
    ivec2 pixel = ray.start_pixel;
    bool  found = false;
    int   taken = 0, strides = 0, steps_left = -1;
    while (!found && t <= real(1) && taken < max_steps)
    {
        ++taken;
        pixel          = pixel_at(ray, t);
        real  depth    = fetch_depth(pixel);
        real3 toward   = normalize(direction_to_vs(ray, ray.origin.xy + t * ray.delta.xy, depth));
        real  needed   = fetch_normal(pixel).y < real(0) ? real(min_alignment_down) : real(min_alignment);
        bool  aligned  = pixel != ray.start_pixel && depth > real(0) && dot(toward, direction) >= needed;
        bool  too_far  = depth > real(0) && dot(toward, up) > dot(direction, up);
        bool  begins   = steps_left < 0 && aligned && depth_at(ray, t) <= depth;
        steps_left     = begins ? binary_steps : steps_left;
        jump           = begins ? dt : jump;
        t_behind       = begins || (steps_left >= 0 && too_far && aligned) ? t : t_behind;
        if (steps_left == 0)
        {
            pixel      = pixel_at(ray, t_behind);
            real2 span = span_in_pixel(ray, grid, pixel);
            t_in       = span.x;
            t_out      = span.y;
            found      = touches_surface(ray, pixel, depth_at(ray, t_in), depth_at(ray, t_out));
        }
        bool searching = steps_left > 0;
        jump          *= real(0.5);
        strides       += int(!searching);
        real t_search  = clamp(t + (too_far ? -jump : jump), real(0), real(1));
        t              = searching ? t_search : (real(strides) + first) * dt;
        --steps_left;
    }
    if (found) return hit_between(ray, pixel, t_in, t_out, taken);
    return t <= real(1) ? out_of_steps(taken) : miss(ray, taken);
}
