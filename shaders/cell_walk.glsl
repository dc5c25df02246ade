// A walk through the cells of the pyramid. It stands in a cell of some level, in a picture mirrored so that its ray runs forward on both axes.
// A cell is left where the ray crosses its border, at the same t on every level; going down chooses the child by comparing t with the middle
// border. So the finest cells passed are exactly the pixels of the walk (docs/exactness.md).
struct CellWalk
{
    Ray      forward; // in the mirrored picture
    Grid     grid;
    ivec2    mirror;
    ivec2    corner; // exit corner of the cell
    int      level;  // below 0: found, the pixel at this corner
    crossing t;      // where the ray enters the cell
    int      visited;
};

// In the cell of this level that holds the first pixel behind the ray's own.
CellWalk start_walk(Ray ray, int level)
{
    CellWalk walk;
    walk.forward       = ray;
    walk.grid          = make_grid(ray);
    walk.mirror        = run_forward(walk.forward, walk.grid);
    walk.corner        = (ray.start_pixel ^ walk.mirror) + 1;
    crossing2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    walk.t             = exit_t(walk.grid, t_border);
    walk.corner        = (next_corner(walk.corner, 1, t_border, walk.t) + (1 << level) - 1) & -(1 << level);
    walk.level         = level;
    walk.visited       = 0;
    return walk;
}

bool goes_on(CellWalk walk)
{
    return walk.level >= 0 && walk.t < walk.grid.t_end && walk.visited < max_steps;
}

ivec2 cell_of(CellWalk walk)
{
    return ((walk.corner - 1) >> walk.level) ^ walk.mirror;
}

crossing t_exit(CellWalk walk)
{
    return exit_t(walk.grid, border_t(walk.forward, walk.grid, walk.corner));
}

// Down into a cell that is touched; else on to the next one, and perhaps up. A walk that has ended stays as it is.
void move(inout CellWalk walk, bool touched, int top)
{
    bool      goes     = goes_on(walk);
    int       size     = 1 << walk.level;
    crossing2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    crossing  t_out    = exit_t(walk.grid, t_border);
    ivec2     child    = child_corner(walk.forward, walk.grid, walk.corner, size, walk.t);
    ivec2     next     = next_corner(walk.corner, size, t_border, t_out);
    // Climb only where the parent changes, because the border that is crossed is its own: the old parent is known to be worth looking into.
    ivec2 crossed = (next - walk.corner) & ~walk.corner;
    int   climb   = walk.level < top && (crossed.x | crossed.y) != 0 ? size : 0;
    int   level   = touched ? walk.level - 1 : climb != 0 ? walk.level + 1 : walk.level;
    walk.t        = goes && !touched ? t_out : walk.t;
    walk.corner   = !goes ? walk.corner : touched ? child : next + (next & climb);
    walk.level    = goes ? level : walk.level;
    walk.visited += int(goes);
}
