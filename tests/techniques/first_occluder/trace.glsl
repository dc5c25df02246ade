// Fragile on purpose: the cell's nearest depth is all it looks at, and where the ray has gone behind a surface the search is over.
uvec2 load_cell(ivec2 cell, int level)
{
    COUNT(pyramid_fetches);
    return load_pyramid(cell, level);
}

TraceResult trace(Ray ray)
{
    Grid  grid     = make_grid(ray);
    real2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    real  t        = exit_t(grid, t_border), t_out = t;
    ivec2 cell     = cross_borders(grid, ray.start_pixel, t_border, t);
    int   top = min(top_level, pyramid_levels()), level = 0, visited = 0;
    bool  behind = false;
    while (!behind && t < grid.t_end && visited < max_steps)
    {
        t_border    = border_t(ray, grid, (cell + grid.forward) << level);
        t_out       = exit_t(grid, t_border);
        real z_far  = min(depth_at(ray, t), depth_at(ray, t_out));
        bool reached = level == 0 ? fetch_depth(cell) >= z_far : cell_nearest(load_cell(cell, level)) >= depth_code(float(z_far));
        behind      = reached && level == 0;

        ivec2 child = child_cell(ray, grid, cell, max(level, 1), t);
        ivec2 next  = cross_borders(grid, cell, t_border, t_out);
        int   climb = int(level < top && (next >> 1) != (cell >> 1));
        t           = reached ? t : t_out;
        cell        = behind ? cell : reached ? child : next >> climb;
        level       = reached ? max(level - 1, 0) : level + climb;
        ++visited;
    }
    if (!behind) return t < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
    if (touches_surface(ray, cell, depth_at(ray, t), depth_at(ray, t_out))) return hit_between(ray, cell, t, t_out, visited);
    return miss(ray, visited);
}
