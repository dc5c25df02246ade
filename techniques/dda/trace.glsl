#include "api/test_pixel.glsl"

TraceResult trace(Ray ray)
{
    Grid      grid     = make_grid(ray);
    crossing2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    crossing  t_out    = exit_t(grid, t_border);
    // The pixel is tracked as an integer: recomputing it from a position would stall on borders.
    ivec2   pixel   = cross_borders(grid, ray.start_pixel, t_border, t_out);
    Contact contact = no_contact();
    int     visited = 0;
    while (!contact.found && t_out < grid.t_end && visited < max_steps)
    {
        crossing t_in = t_out;
        t_border      = border_t(ray, grid, pixel + grid.forward);
        t_out         = exit_t(grid, t_border);
        contact       = test_pixel(ray, grid, pixel, t_in, t_out);
        pixel         = cross_borders(grid, pixel, t_border, t_out);
        ++visited;
    }
    if (contact.found) return hit(ray, contact, visited);
    return t_out < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
