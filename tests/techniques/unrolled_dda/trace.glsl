// The walk of techniques/dda, two rays at a time and two pixels of each in one iteration, in a picture mirrored so that they run forward.
#define TRACES_PAIRS
struct PixelWalk
{
    Ray   forward; // in the mirrored picture
    Grid  grid;
    ivec2 mirror, corner; // exit corner of the pixel
    bool  found;
    real  t; // where the ray enters the pixel
    int   visited;
};

PixelWalk start_walk(Ray ray)
{
    PixelWalk walk;
    walk.forward   = ray;
    walk.grid      = make_grid(ray);
    walk.mirror    = run_forward(walk.forward, walk.grid);
    walk.corner    = (ray.start_pixel ^ walk.mirror) + 1;
    real2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    walk.t         = exit_t(walk.grid, t_border);
    walk.corner    = next_corner(walk.corner, 1, t_border, walk.t);
    walk.found     = false;
    walk.visited   = 0;
    return walk;
}

bool goes_on(PixelWalk walk)
{
    return !walk.found && walk.t < walk.grid.t_end && walk.visited < max_steps;
}

void visit(Ray ray, inout PixelWalk walk, int number)
{
    bool  goes     = goes_on(walk);
    current_ray    = goes ? number : 2;
    real2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    real  t_out    = exit_t(walk.grid, t_border);
    bool  touched  = touches_surface(ray, walk.grid, (walk.corner - 1) ^ walk.mirror, walk.t, t_out);
    bool  leaves   = goes && !touched;
    ivec2 next     = next_corner(walk.corner, 1, t_border, t_out);
    walk.t         = leaves ? t_out : walk.t;
    walk.corner    = leaves ? next : walk.corner;
    walk.found     = walk.found || (goes && touched);
    walk.visited += int(goes);
}

TraceResult finish(Ray ray, PixelWalk walk, int number)
{
    current_ray = number;
    if (!walk.found) return walk.t < walk.grid.t_end ? out_of_steps(walk.visited) : miss(ray, walk.visited);
    real t_out = exit_t(walk.grid, border_t(walk.forward, walk.grid, walk.corner));
    return hit_between(ray, (walk.corner - 1) ^ walk.mirror, walk.t, t_out, walk.visited);
}

void trace_pair(Ray ray_a, Ray ray_b, out TraceResult result_a, out TraceResult result_b)
{
    PixelWalk a = start_walk(ray_a), b = start_walk(ray_b);
    while (goes_on(a) || goes_on(b))
    {
        visit(ray_a, a, 0);
        visit(ray_b, b, 1);
        visit(ray_a, a, 0);
        visit(ray_b, b, 1);
    }
    result_a = finish(ray_a, a, 0);
    result_b = finish(ray_b, b, 1);
}
