// Fragile on purpose: the pixel is found again from the position at every step, and an epsilon beyond the border keeps it moving.
// Too small where coordinates are large (the step rounds away), too large where a ray cuts a corner (that pixel is skipped).
// Stingray's hi-z trace: an absolute 1e-5 of the image.
#include "api/sampling.glsl"

real2 epsilon_px()
{
    return real2(1e-5) * real2(size_px);
}

bool on_screen(ivec2 pixel)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size_px));
}

real2 position_at(Ray ray, real t)
{
    return ray.origin.xy + t * ray.delta.xy;
}

TraceResult trace(Ray ray)
{
    real2 inverse = real2(1) / ray.delta.xy; // infinite for axis-aligned rays, whose t is then minus infinity or NaN
    real2 epsilon = sign(ray.delta.xy) * epsilon_px();
    real  t = real(0), t_next = real(0);
    ivec2   pixel   = ray.start_pixel;
    Contact contact = no_contact();
    bool    ended   = false;
    int     visited = 0;
    while (!ended && !contact.found && visited < max_steps)
    {
        ++visited;
        real2 border = real2(pixel) + real2(greaterThan(ray.delta.xy, real2(0))) + epsilon;
        real2 t_axis = (border - ray.origin.xy) * inverse;
        t_next       = min(t_axis.x, t_axis.y);
        if (pixel != ray.start_pixel) contact = test_pixel(ray, pixel, t, min(t_next, real(1)));
        ended        = !(t_next < real(1));
        ivec2 next   = ivec2(floor(position_at(ray, t_next)));
        ended        = ended || !on_screen(next);
        t            = t_next;
        pixel        = next;
    }
    if (contact.found) return hit(ray, contact, visited);
    return ended ? miss(ray, visited) : out_of_steps(visited);
}
