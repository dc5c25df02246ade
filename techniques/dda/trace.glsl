TraceResult trace(Ray ray)
{
    Grid      grid     = make_grid(ray);
    crossing2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    crossing  t_in     = crossing(0), t_out = exit_t(grid, t_border);
    // The pixel is tracked as an integer: recomputing it from a position would stall on borders.
    ivec2 pixel   = cross_borders(grid, ray.start_pixel, t_border, t_out);
    bool  found   = false;
    int   visited = 0;
    while (!found && t_out < grid.t_end && visited < max_steps)
    {
        t_in       = t_out;
        t_border   = border_t(ray, grid, pixel + grid.forward);
        t_out      = exit_t(grid, t_border);
        found      = touches_surface(ray, grid, pixel, t_in, t_out);
        ivec2 next = cross_borders(grid, pixel, t_border, t_out);
        pixel      = found ? pixel : next;
        ++visited;
    }
    if (found) return hit_between(ray, pixel, crossing_to_t(grid, t_in), crossing_to_t(grid, t_out), visited);
    return t_out < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
