// Screen t of sample i; > 1 beyond the end of the segment.
real sample_t(Ray ray, int i)
{
    if (space == space_pixels) return real(i) * stride_to_t(ray, real(stride_px));
    real fraction = real(i) / real(steps);
    return space == space_screen ? fraction : metres_to_t(ray, max_distance_m * fraction);
}

TraceResult hit(Ray ray, ivec2 pixel, real t_before, real t, int taken)
{
    return interval ? hit_at(ray, pixel, t_before, t, taken) : hit_at_sample(ray, pixel, t, taken);
}

TraceResult trace(Ray ray)
{
    real  t_before = real(0), t = real(0);
    ivec2 pixel = ray.start_pixel;
    bool  ended = false, found = false;
    int   taken = 0;
    while (!ended && !found && taken < steps)
    {
        ++taken;
        t_before = t;
        t        = sample_t(ray, taken);
        ended    = t > real(1);
        pixel    = pixel_at(ray, t);
        found    = !ended && pixel != ray.start_pixel && (interval ? touches_surface(ray, pixel, t_before, t) : touches_sample(ray, pixel, t));
    }
    if (!found) return space == space_pixels && !ended && sample_t(ray, taken + 1) <= real(1) ? out_of_steps(taken) : miss(ray, taken);
    if (!interpolate || ray.delta.z == real(0)) return hit(ray, pixel, t_before, t, taken);

    ivec2 front = pixel_at(ray, clamp((fetch_depth(pixel) - ray.origin.z) / ray.delta.z, t_before, t));
    real2 span  = span_in_pixel(ray, make_grid(ray), front);
    bool  moves = front != ray.start_pixel && touches_surface(ray, front, span.x, span.y);
    return moves ? hit_between(ray, front, span.x, span.y, taken) : hit(ray, pixel, t_before, t, taken);
}
