// Two rays at a time: what one visit waits for, the other ray's visit can use (docs/performance.md).
#define TRACES_PAIRS
#include "cell_walk.glsl"

int top = min(top_level, pyramid_levels());

// number: the ray's current_ray.
CellContent look(CellWalk walk, int number)
{
    current_ray = goes_on(walk) ? number : 2;
    return fetch_cell(pixel_of(walk), walk.level);
}

void visit(Ray ray, inout CellWalk walk, CellContent content, int number)
{
    current_ray  = goes_on(walk) ? number : 2;
    bool touched = touches_cell(ray, walk.grid, pixel_of(walk), walk.level, content, walk.t, t_exit(walk));
    move(walk, touched, top);
}

TraceResult finish(Ray ray, CellWalk walk, int number)
{
    current_ray = number;
    if (walk.level >= 0) return walk.t < walk.grid.t_end ? out_of_steps(walk.visited) : miss(ray, walk.visited);
    ivec2 pixel = pixel_of(walk);
    return hit_between(ray, pixel, crossing_to_t(walk.grid, walk.t), crossing_to_t(walk.grid, t_exit(walk)), walk.visited);
}

void trace_pair(Ray ray_a, Ray ray_b, out TraceResult result_a, out TraceResult result_b)
{
    int      level = min(start_level, top), stretch = 0;
    CellWalk a = start_walk(ray_a, level), b = start_walk(ray_b, level);
    real2    clear = clear_stretch(0);
    stop_at(a, clear.x);
    stop_at(b, clear.x);
    do
    {
        while (goes_on(a) || goes_on(b))
        {
            // Both reads are under way before one is waited for.
            CellContent cell_a = look(a, 0), cell_b = look(b, 1);
            visit(ray_a, a, cell_a, 0);
            visit(ray_b, b, cell_b, 1);
        }
        leap(a, min(LEAP_LEVEL, top), clear.y);
        leap(b, min(LEAP_LEVEL, top), clear.y);
        ++stretch;
        // Here, not before the walk: its loop would work the end out at every turn (docs/performance.md).
        clear = clear_stretch(stretch);
        stop_at(a, clear.x);
        stop_at(b, clear.x);
    } while (stretch <= BEAM_STRETCHES && (is_open(a) || is_open(b)));
    result_a = finish(ray_a, a, 0);
    result_b = finish(ray_b, b, 1);
}
