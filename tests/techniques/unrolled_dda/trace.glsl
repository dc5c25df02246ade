TraceResult trace(Ray ray)
{
    Grid  grid     = make_grid(ray);
    real2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    real  t_in     = real(0), t_out = exit_t(grid, t_border);
    ivec2 pixel    = cross_borders(grid, ray.start_pixel, t_border, t_out);
    bool  found    = false;
    int   visited  = 0;
    while (!found && t_out < grid.t_end && visited < max_steps)
    {
        t_in            = t_out;
        real2 border_1  = border_t(ray, grid, pixel + grid.forward);
        real  t_1       = exit_t(grid, border_1);
        ivec2 pixel_2   = cross_borders(grid, pixel, border_1, t_1);
        real2 border_2  = border_t(ray, grid, pixel_2 + grid.forward);
        real  t_2       = exit_t(grid, border_2);
        real  z_1       = depth_at(ray, t_1);
        bool  found_1   = touches_surface(ray, pixel, depth_at(ray, t_in), z_1);
        // The second pixel is read in any case, and counts only if the walk gets there.
        bool  reached   = !found_1 && t_1 < grid.t_end && visited + 1 < max_steps;
        bool  found_2   = touches_surface(ray, pixel_2, z_1, depth_at(ray, t_2)) && reached;
        found           = found_1 || found_2;
        t_in            = found_2 ? t_1 : t_in;
        t_out           = reached ? t_2 : t_1;
        ivec2 next      = reached ? cross_borders(grid, pixel_2, border_2, t_2) : pixel_2;
        pixel           = found_1 ? pixel : found_2 ? pixel_2 : next;
        visited += reached ? 2 : 1;
    }
    if (found) return hit_between(ray, pixel, t_in, t_out, visited);
    return t_out < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
