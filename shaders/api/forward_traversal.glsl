// A walk through the cells of a pyramid, in an image mirrored so that its ray runs forward on both axes: pixel p becomes p ^ mirror, and crossings keep
// their bits, since only signs change. A cell is named by its exit corner: the borders where the ray leaves it, x and y multiples of its size in pixels.
// A cell is left where the ray crosses its border, at the same t on every level; going down chooses the child by comparing t with the middle border. So
// the finest cells passed are exactly the pixels of the walk (docs/explanation/exactness.md). Float only. The technique has a parameter max_steps.
struct Traversal
{
    Ray   forward; // in the mirrored image
    Grid  grid;
    ivec2 mirror;
    ivec2 corner; // exit corner of the cell
    int   level;  // below 0: found, the pixel at this corner
    real  t;      // where the ray enters the cell
    real  t_stop; // the walk goes no farther than the cell in which the ray is there
    int   visited;
    Contact contact; // what was tested last
};

// Level of the cell in which a walk arrives behind an empty interval: nothing is known of what follows.
#define SKIP_LEVEL 3

// Mirrors the image so that the ray runs toward larger coordinates on both axes.
ivec2 run_forward(inout Ray ray, inout Grid grid)
{
    ivec2 mirror       = grid.forward - 1;
    ray.origin.xy      = mix(ray.origin.xy, -ray.origin.xy, notEqual(mirror, ivec2(0)));
    ray.delta.xy       = abs(ray.delta.xy);
    grid.inverse_delta = abs(grid.inverse_delta);
    grid.forward       = ivec2(1);
    return mirror;
}

// The corner of the neighbour behind the border, or the corner, that is crossed at t.
ivec2 next_corner(ivec2 corner, int size, real2 t_border, real t)
{
    return mix(corner, corner + size, lessThanEqual(t_border, real2(t)));
}

// The corner of the quarter of the cell that holds the ray at t.
ivec2 child_corner(Ray ray, Grid grid, ivec2 corner, int size, real t)
{
    ivec2 middle = corner - (size >> 1);
    return mix(middle, corner, lessThanEqual(border_t(ray, grid, middle), real2(t)));
}

// In the cell of this level that holds the first pixel behind the ray's own.
Traversal start_traversal(Ray ray, int level)
{
    Traversal walk;
    walk.forward   = ray;
    walk.grid      = make_grid(ray);
    walk.mirror    = run_forward(walk.forward, walk.grid);
    walk.corner    = (ray.start_pixel ^ walk.mirror) + 1;
    real2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    walk.t         = exit_t(walk.grid, t_border);
    walk.corner    = (next_corner(walk.corner, 1, t_border, walk.t) + (1 << level) - 1) & -(1 << level);
    walk.level     = level;
    walk.t_stop    = walk.grid.t_end;
    walk.visited   = 0;
    walk.contact   = no_contact();
    return walk;
}

// Has it neither found anything yet nor ended?
bool is_open(Traversal walk) { return walk.level >= 0 && walk.t < walk.grid.t_end && walk.visited < max_steps; }

// The same, up to where it has to stop.
bool is_active(Traversal walk) { return walk.level >= 0 && walk.t < walk.t_stop && walk.visited < max_steps; }

// The last pixel of the cell on both axes, in the image itself.
ivec2 pixel_of(Traversal walk) { return (walk.corner - 1) ^ walk.mirror; }

real t_exit(Traversal walk) { return exit_t(walk.grid, border_t(walk.forward, walk.grid, walk.corner)); }

// Down into a cell that is touched; else on to the next one, and perhaps up. A walk that has ended stays as it is.
void advance(inout Traversal walk, bool touched, int top)
{
    bool  moves    = is_active(walk);
    int   size     = 1 << walk.level;
    real2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    real  t_out    = exit_t(walk.grid, t_border);
    ivec2 child    = child_corner(walk.forward, walk.grid, walk.corner, size, walk.t);
    ivec2 next     = next_corner(walk.corner, size, t_border, t_out);
    // Climb only where the parent changes, because the border that is crossed is its own: the old parent is known to be worth looking into.
    ivec2 crossed = (next - walk.corner) & ~walk.corner;
    int   climb   = walk.level < top && (crossed.x | crossed.y) != 0 ? size : 0;
    int   level   = touched ? walk.level - 1 : climb != 0 ? walk.level + 1 : walk.level;
    walk.t        = moves && !touched ? t_out : walk.t;
    walk.corner   = !moves ? walk.corner : touched ? child : next + (next & climb);
    walk.level    = moves ? level : walk.level;
    walk.visited += int(moves);
}

// A cell was tested: down into it if the ray may meet something there, else on.
void advance(inout Traversal walk, Contact contact, int top)
{
    if (is_active(walk)) walk.contact = contact;
    advance(walk, contact.found, top);
}

void stop_at(inout Traversal walk, real t) { walk.t_stop = t < walk.grid.t_end ? t : walk.grid.t_end; }

// Skips an empty interval, to the cell of this level in which the ray is at t: there it stands as if it had walked. Position names that cell but for
// rounding; where its borders say otherwise, the walk goes on cell by cell. A skip visits nothing, so an exhausted step budget prevents it only if the
// walk stopped before the interval.
void skip_to(inout Traversal walk, int level, real t)
{
    int   size     = 1 << level;
    ivec2 corner   = (ivec2(floor(walk.forward.origin.xy + t * walk.forward.delta.xy)) | (size - 1)) + 1;
    real2 t_in     = border_t(walk.forward, walk.grid, corner - size), t_out = border_t(walk.forward, walk.grid, corner);
    real  t_entry  = t_in.x > t_in.y ? t_in.x : t_in.y;
    bool  arrives  = t_entry <= t && t < t_out.x && t < t_out.y, ends = t >= walk.grid.t_end;
    real2 delta_px = (t - walk.t) * walk.forward.delta.xy;
    bool  pays     = delta_px.x > real(2 * size) || delta_px.y > real(2 * size);
    bool  skips    = (arrives || ends) && pays && walk.level >= 0 && walk.t >= walk.t_stop && walk.t < walk.grid.t_end;
    walk.t         = !skips ? walk.t : ends ? walk.grid.t_end : t_entry;
    walk.corner    = skips ? corner : walk.corner;
    walk.level     = skips ? level : walk.level;
}

// Of a walk that has ended.
TraceResult result_of(Ray ray, Traversal walk)
{
    if (walk.level >= 0) return walk.t < walk.grid.t_end ? out_of_steps(walk.visited) : miss(ray, walk.visited);
    return hit_between(ray, walk.contact, pixel_of(walk), walk.t, t_exit(walk), walk.visited);
}
