// Screen t of sample i; > 1 beyond the end of the segment.
real sample_t(Ray ray, int i)
{
    real fraction = real(i) / real(steps);
    if (space == space_screen) return fraction;
    real along = max_distance_m * fraction / ray.length_m;
    return along > real(1) ? real(2) : fraction_to_t(ray, along);
}

TraceResult trace(Ray ray)
{
    real  t = real(0), z = ray.origin.z;
    ivec2 pixel = ray.start_pixel;
    bool  found = false;
    int   i     = 1;
    for (; i <= steps; ++i)
    {
        t = sample_t(ray, i);
        if (t > real(1)) break;
        real z_before = z;
        pixel = pixel_at(ray, t);
        z     = depth_at(ray, t);
        found = pixel != ray.start_pixel && touches_surface(ray, pixel, interval ? z_before : z, z);
        if (found) break;
    }
    i = min(i, steps);
    if (found) return hit_at(ray, pixel, t, i);
    return miss(ray, i);
}
