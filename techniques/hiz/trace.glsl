// The state is (cell, level, entry t). A cell is left where the ray crosses its border, at the same t on every level; going down chooses
// the child by comparing t with the middle border. So the finest cells passed are exactly the pixels of the walk (docs/exactness.md).
bool cell_touched(Ray ray, ivec2 cell, int level, real z_a, real z_b)
{
    if (level == 0) return touches_surface(ray, cell, z_a, z_b);
    real2 node = fetch_pyramid(cell, level);
    return node.x >= min(z_a, z_b) && node.y <= max(z_a, z_b);
}

// The quarter of a cell of `level` that holds the ray at t.
ivec2 child_at(Ray ray, Grid grid, ivec2 cell, int level, real t)
{
    real2 t_middle = border_t(ray, grid, (2 * cell + 1) << (level - 1));
    return 2 * cell + (ivec2(lessThanEqual(t_middle, real2(t))) ^ (1 - grid.forward));
}

TraceResult trace(Ray ray)
{
    Grid  grid     = make_grid(ray);
    real2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    real  t        = min(t_border.x, t_border.y), t_out = t;
    ivec2 cell     = cross_borders(grid, ray.start_pixel, t_border, t);
    bool  ended = t >= real(1) || !on_screen(cell), found = false;
    int   top   = min(top_level, pyramid_levels()), level = min(start_level, top), visited = 0;
    cell >>= level;
    while (!ended && !found && visited < max_steps)
    {
        t_border = border_t(ray, grid, (cell + grid.forward) << level);
        t_out    = min(min(t_border.x, t_border.y), real(1));
        ++visited;
        bool touched = cell_touched(ray, cell, level, depth_at(ray, t), depth_at(ray, t_out));
        found        = touched && level == 0;
        if (touched && !found)
        {
            cell = child_at(ray, grid, cell, level, t);
            --level;
        }
        if (!touched)
        {
            ivec2 parent = cell >> 1;
            cell         = cross_borders(grid, cell, t_border, t_out);
            t            = t_out;
            ended        = t >= real(1) || !on_screen(cell << level);
            // Climb only where the parent changes: the old parent is known to be worth looking into.
            bool climb = level < top && (cell >> 1) != parent;
            cell >>= int(climb);
            level += int(climb);
        }
    }
    if (found) return hit_between(ray, cell, t, t_out, visited);
    return ended ? miss(ray, visited) : out_of_steps(visited);
}
