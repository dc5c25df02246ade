#include "api/depth_interval.glsl"
#include "api/test_pixel.glsl"

TraceResult trace(Ray ray)
{
    Grid  grid     = make_grid(ray);
    real2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    real  t_in     = real(0), t_out = exit_t(grid, t_border);
    ivec2 pixel    = cross_borders(grid, ray.start_pixel, t_border, t_out);
    int   visited  = 0;
    Contact contact = no_contact();
    while (!contact.found && t_out < grid.t_end && visited < max_steps)
    {
        t_in        = t_out;
        t_border    = border_t(ray, grid, pixel + grid.forward);
        t_out       = exit_t(grid, t_border);
        real2 z     = depth_interval(ray, depth_at(ray, t_in), depth_at(ray, t_out));
        bool behind = z.x <= fetch_tile_front(pixel);
        if (behind) contact = test_pixel(ray, grid, pixel, t_in, t_out);
        pixel       = cross_borders(grid, pixel, t_border, t_out);
        ++visited;
    }
    if (contact.found) return hit(ray, contact, visited);
    return t_out < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
