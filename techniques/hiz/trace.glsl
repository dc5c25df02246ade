// Walks the cells of the depth pyramid: opens one that the ray may touch, else goes on, and up where the parent changes.
TraceResult trace(Ray ray)
{
    Grid      grid     = make_grid(ray);
    int       top      = pyramid_top(), level = min(start_level, top), visited = 0;
    crossing2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    crossing  t_in     = exit_t(grid, t_border), t_out = t_in;
    ivec2     cell     = cross_borders(grid, ray.start_pixel, t_border, t_in) >> level;
    Contact   contact  = no_contact();
    bool      found    = false;
    while (!found && t_in < grid.t_end && visited < max_steps)
    {
        ivec2 pixel    = cell << level;
        t_border       = border_t(ray, grid, (cell + grid.forward) << level);
        t_out          = exit_t(grid, t_border);
        contact        = test_cell(ray, grid, pixel, level, fetch_cell(pixel, level), t_in, t_out);
        found          = contact.found && level == 0;
        if (contact.found && level > 0)
        {
            // Of the four cells below, the one that holds the ray at t_in.
            --level;
            bvec2 beyond = lessThanEqual(border_t(ray, grid, (2 * cell + 1) << level), crossing2(t_in));
            cell         = 2 * cell + ivec2(equal(ivec2(beyond), grid.forward));
        }
        else if (!found)
        {
            ivec2 next = cross_borders(grid, cell, t_border, t_out);
            bool  up   = level < top && next >> 1 != cell >> 1;
            cell       = up ? next >> 1 : next;
            level += int(up);
            t_in       = t_out;
        }
        ++visited;
    }
    if (found) return hit_between(ray, contact, cell, crossing_to_t(grid, t_in), crossing_to_t(grid, t_out), visited);
    return t_in < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
