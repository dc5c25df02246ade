#include "api/sampling.glsl"

// Screen t of sample i; > 1 beyond the end of the segment.
real sample_t(Ray ray, int i)
{
    if (space == space_pixels) return real(i) * stride_to_t(ray, real(stride_px));
    real fraction = real(i) / real(steps);
    return space == space_screen ? fraction : metres_to_t(ray, max_distance_m * fraction);
}

TraceResult trace(Ray ray)
{
    real t_free = real(0), t = real(0);
    Contact contact = no_contact();
    bool    ended = false;
    int     taken = 0;
    while (!ended && !contact.found && taken < steps)
    {
        ++taken;
        t_free        = t;
        t             = sample_t(ray, taken);
        ended         = t > real(1);
        ivec2 pixel   = pixel_at(ray, t);
        if (!ended && pixel != ray.start_pixel) contact = test_sample(ray, pixel, t);
    }
    if (!contact.found) return space == space_pixels && !ended && sample_t(ray, taken + 1) <= real(1) ? out_of_steps(taken) : miss(ray, taken);

    // The bracket: free at t_free, a hit at t. Asking for the slab, not just for its front, never moves t out of one.
    for (int k = 0; k < binary_steps; ++k)
    {
        real    middle = real(0.5) * (t_free + t);
        ivec2   pixel  = pixel_at(ray, middle);
        Contact nearer = no_contact();
        if (pixel != ray.start_pixel) nearer = test_sample(ray, pixel, middle);
        if (nearer.found) contact = nearer;
        t_free = nearer.found ? t_free : middle;
        t      = nearer.found ? middle : t;
    }
    return hit(ray, contact, taken + binary_steps);
}
