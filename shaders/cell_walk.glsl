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
    crossing t_stop; // the walk goes no farther than the cell in which the ray is there
    int      visited;
};

// Level of the cell in which a walk arrives behind a clear stretch: nothing is known of what follows.
#define LEAP_LEVEL 3

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
    walk.t_stop        = walk.grid.t_end;
    walk.visited       = 0;
    return walk;
}

// Neither found anything yet nor ended.
bool is_open(CellWalk walk)
{
    return walk.level >= 0 && walk.t < walk.grid.t_end && walk.visited < max_steps;
}

bool goes_on(CellWalk walk)
{
    return walk.level >= 0 && walk.t < walk.t_stop && walk.visited < max_steps;
}

// The last pixel of the cell on both axes, in the picture itself.
ivec2 pixel_of(CellWalk walk)
{
    return (walk.corner - 1) ^ walk.mirror;
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

#ifdef EXACT_ARITHMETIC
// A walk by exact crossings passes over nothing.
void stop_at(inout CellWalk walk, real t) {}
void leap(inout CellWalk walk, int level, real t) {}
#else
void stop_at(inout CellWalk walk, real t)
{
    walk.t_stop = t < walk.grid.t_end ? t : walk.grid.t_end;
}

// Passes over a stretch without surfaces, to the cell of this level in which the ray is at t: there it stands as if it had walked. Position names
// that cell but for rounding; where its borders say otherwise, the walk goes on cell by cell.
// It visits nothing, so a budget that is spent forbids it only where the walk stopped before the stretch.
void leap(inout CellWalk walk, int level, real t)
{
    int   size    = 1 << level;
    ivec2 corner  = (ivec2(floor(walk.forward.origin.xy + t * walk.forward.delta.xy)) | (size - 1)) + 1;
    real2 t_in    = border_t(walk.forward, walk.grid, corner - size), t_out = border_t(walk.forward, walk.grid, corner);
    real  t_entry = t_in.x > t_in.y ? t_in.x : t_in.y;
    bool  arrives = t_entry <= t && t < t_out.x && t < t_out.y, ends = t >= walk.grid.t_end;
    real2 way_px  = (t - walk.t) * walk.forward.delta.xy;
    bool  pays    = way_px.x > real(2 * size) || way_px.y > real(2 * size);
    bool  goes    = (arrives || ends) && pays && walk.level >= 0 && walk.t >= walk.t_stop && walk.t < walk.grid.t_end;
    walk.t        = !goes ? walk.t : ends ? walk.grid.t_end : t_entry;
    walk.corner   = goes ? corner : walk.corner;
    walk.level    = goes ? level : walk.level;
}
#endif
