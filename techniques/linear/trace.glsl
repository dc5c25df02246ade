// Screen t of sample i; > 1 beyond the end of the segment.
real sample_t(Ray ray, int i)
{
    real fraction = real(i) / real(steps);
    return space == space_screen ? fraction : metres_to_t(ray, max_distance_m * fraction);
}

TraceResult trace(Ray ray)
{
    real  t = real(0), z = ray.origin.z;
    ivec2 pixel = ray.start_pixel;
    bool  ended = false, found = false;
    int   taken = 0;
    while (!ended && !found && taken < steps)
    {
        ++taken;
        real z_before = z;
        t     = sample_t(ray, taken);
        ended = t > real(1);
        pixel = pixel_at(ray, t);
        z     = depth_at(ray, t);
        found = !ended && pixel != ray.start_pixel && touches_surface(ray, pixel, interval ? z_before : z, z);
    }
    if (found) return hit_at(ray, pixel, t, taken);
    return miss(ray, taken);
}
