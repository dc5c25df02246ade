// Two rays at a time: what one visit waits for, the other ray's visit can use (docs/explanation/performance.md).
#include "api/forward_traversal.glsl"

int top = pyramid_top();

// own_lane: that of the ray.
uvec2 fetch(Traversal walk, int own_lane)
{
    lane = is_active(walk) ? own_lane : 2;
    return fetch_cell(pixel_of(walk), walk.level);
}

void visit(Ray ray, inout Traversal walk, uvec2 words, int own_lane)
{
    lane = is_active(walk) ? own_lane : 2;
    advance(walk, test_cell(ray, walk.grid, pixel_of(walk), walk.level, words, walk.t, t_exit(walk)), top);
}

TraceResult finish(Ray ray, Traversal walk, int own_lane)
{
    lane = own_lane;
    return result_of(ray, walk);
}

void trace_pair(Ray ray_a, Ray ray_b, out TraceResult result_a, out TraceResult result_b)
{
    int       level = min(start_level, top), number = 0;
    Traversal a = start_traversal(ray_a, level), b = start_traversal(ray_b, level);
    real2     empty = empty_interval(0);
    stop_at(a, empty.x);
    stop_at(b, empty.x);
    // This short loop around much work ends at the bottom (docs/explanation/performance.md): its body must not change its results once its condition is false.
    do
    {
        while (is_active(a) || is_active(b))
        {
            // Both reads are under way before one is waited for.
            uvec2 cell_a = fetch(a, 0), cell_b = fetch(b, 1);
            visit(ray_a, a, cell_a, 0);
            visit(ray_b, b, cell_b, 1);
        }
        skip_to(a, min(SKIP_LEVEL, top), empty.y);
        skip_to(b, min(SKIP_LEVEL, top), empty.y);
        ++number;
        // Here, not before the walk: its loop would work the end out in every iteration (docs/explanation/performance.md).
        empty = empty_interval(number);
        stop_at(a, empty.x);
        stop_at(b, empty.x);
    } while (number <= intervals_count && (is_open(a) || is_open(b)));
    result_a = finish(ray_a, a, 0);
    result_b = finish(ray_b, b, 1);
}
