// Fragile on purpose: the cell's nearest depth is all it looks at, and where the ray has gone behind a surface the search is over.
// Walks as techniques/hiz does, two rays at a time.
#define TRACES_PAIRS
#include "cell_walk.glsl"

int top = min(top_level, pyramid_levels());

// Is the ray, where it is farthest in the cell, behind the cell's nearest depth?
bool gets_behind(Ray ray, CellWalk walk, real front)
{
    return front >= depth_at(ray, ray.delta.z < real(0) ? t_exit(walk) : walk.t);
}

real look(CellWalk walk, int number)
{
    current_ray = goes_on(walk) ? number : 2;
    return fetch_front(pixel_of(walk), walk.level);
}

TraceResult finish(Ray ray, CellWalk walk, int number)
{
    current_ray = number;
    if (walk.level >= 0) return walk.t < walk.grid.t_end ? out_of_steps(walk.visited) : miss(ray, walk.visited);
    ivec2    pixel = pixel_of(walk);
    crossing t_out = t_exit(walk);
    if (touches_surface(ray, pixel, depth_at(ray, walk.t), depth_at(ray, t_out))) return hit_between(ray, pixel, walk.t, t_out, walk.visited);
    return miss(ray, walk.visited);
}

void walk_on(Ray ray_a, Ray ray_b, inout CellWalk a, inout CellWalk b)
{
    while (goes_on(a) || goes_on(b))
    {
        real front_a = look(a, 0), front_b = look(b, 1);
        move(a, gets_behind(ray_a, a, front_a), top);
        move(b, gets_behind(ray_b, b, front_b), top);
    }
}

void trace_pair(Ray ray_a, Ray ray_b, out TraceResult result_a, out TraceResult result_b)
{
    CellWalk a = start_walk(ray_a, 0), b = start_walk(ray_b, 0);
    real2    clear = clear_stretch(0); // in front of everything there is one
    stop_at(a, clear.x);
    stop_at(b, clear.x);
    walk_on(ray_a, ray_b, a, b);
    leap(a, min(LEAP_LEVEL, top), clear.y);
    leap(b, min(LEAP_LEVEL, top), clear.y);
    a.t_stop = a.grid.t_end;
    b.t_stop = b.grid.t_end;
    walk_on(ray_a, ray_b, a, b);
    result_a = finish(ray_a, a, 0);
    result_b = finish(ray_b, b, 1);
}
