#include "api/sampling.glsl"
#include "api/random.glsl"

TraceResult trace(Ray ray)
{
    // Shifted forward: nearer than a stride, half a step ahead already reaches below the floor that the ray comes from.
    real  dt = stride_to_t(ray, real(stride_px)), first = real(1) + real(jitter) * random_of(ray.start_pixel);
    real  t = real(0), t_tested = start_pixel_end_t(ray);
    Contact contact = no_contact();
    int     taken = 0;
    while (!contact.found && t_tested < real(1) && taken < max_steps)
    {
        real t_before = t_tested;
        t             = min((real(taken) + first) * dt, real(1));
        t_tested      = clamp((real(taken) + first + real(0.5)) * dt, t_before, real(1));
        ivec2 pixel   = pixel_at(ray, t);
        if (pixel != ray.start_pixel) contact = test_pixel(ray, pixel, t_before, t_tested);
        ++taken;
    }
    if (contact.found) return hit_at(ray, contact, t, taken);
    return t_tested < real(1) ? out_of_steps(taken) : miss(ray, taken);
}
