// The state is (cell, level, entry t). A cell is left where the ray crosses its border, at the same t on every level; going down chooses
// the child by comparing t with the middle border. So the finest cells passed are exactly the pixels of the walk (docs/exactness.md).
TraceResult trace(Ray ray)
{
    Grid      grid     = make_grid(ray);
    crossing2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    crossing  t        = exit_t(grid, t_border), t_out = t;
    int   top = min(top_level, pyramid_levels()), level = min(start_level, top), visited = 0;
    ivec2 cell  = cross_borders(grid, ray.start_pixel, t_border, t) >> level;
    bool  found = false;
    while (!found && t < grid.t_end && visited < max_steps)
    {
        t_border     = border_t(ray, grid, (cell + grid.forward) << level);
        t_out        = exit_t(grid, t_border);
        bool touched = touches_cell(ray, grid, cell, level, t, t_out);
        found        = touched && level == 0;

        int   below = max(level - 1, 0);
        ivec2 child = child_cell(ray, grid, cell, below + 1, t);
        ivec2 next  = cross_borders(grid, cell, t_border, t_out);
        // Climb only where the parent changes: the old parent is known to be worth looking into.
        int climb = int(level < top && (next >> 1) != (cell >> 1));
        t         = touched ? t : t_out;
        cell      = found ? cell : touched ? child : next >> climb;
        level     = touched ? below : level + climb;
        ++visited;
    }
    if (found) return hit_between(ray, cell, crossing_to_t(grid, t), crossing_to_t(grid, t_out), visited);
    return t < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
