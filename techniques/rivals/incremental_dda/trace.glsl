// Fragile on purpose: each addition rounds, so t drifts from the border it stands for. Corners are broken by "x first unless y is nearer".
#include "api/sampling.glsl"

bool on_screen(ivec2 pixel)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size_px));
}

TraceResult trace(Ray ray)
{
    Grid  grid    = make_grid(ray);
    ivec2 step    = 2 * grid.forward - 1;
    real2 t_delta = abs(grid.inverse_delta);
    real2 t_max   = border_t(ray, grid, ray.start_pixel + grid.forward);
    ivec2 pixel   = ray.start_pixel;
    real  t_in    = real(0), t_out = min(t_max.x, t_max.y);
    Contact contact = no_contact();
    bool    ended   = false;
    int     visited = 0;
    while (!ended && !contact.found && visited < max_steps)
    {
        t_in = t_out;
        if (t_max.x <= t_max.y)
        {
            pixel.x += step.x;
            t_max.x += t_delta.x;
        }
        else
        {
            pixel.y += step.y;
            t_max.y += t_delta.y;
        }
        t_out = min(min(t_max.x, t_max.y), real(1));
        ended = t_in >= real(1) || !on_screen(pixel);
        if (!ended) contact = test_pixel(ray, pixel, t_in, t_out);
        ++visited;
    }
    if (contact.found) return hit(ray, contact, visited);
    return ended ? miss(ray, visited) : out_of_steps(visited);
}
