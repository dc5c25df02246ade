// Fragile on purpose: the cell's nearest depth is all it looks at, and where the ray has gone behind a surface the search is over.
// Walks as techniques/hiz_packets does, two rays at a time.
#include "api/sampling.glsl"
#include "structures/depth_pyramid/front.glsl"
#include "api/forward_traversal.glsl"

int top = pyramid_top();

// Is the ray, where it is farthest in the cell, behind the cell's nearest depth?
bool gets_behind(Ray ray, Traversal walk, real front)
{
    return front >= depth_at(ray, ray.delta.z < real(0) ? t_exit(walk) : walk.t);
}

real front_of(Traversal walk, int own_lane)
{
    lane = is_active(walk) ? own_lane : 2;
    return fetch_front(pixel_of(walk), walk.level);
}

TraceResult finish(Ray ray, Traversal walk, int own_lane)
{
    lane = own_lane;
    if (walk.level >= 0) return walk.t < walk.grid.t_end ? out_of_steps(walk.visited) : miss(ray, walk.visited);
    Contact contact = test_pixel(ray, pixel_of(walk), walk.t, t_exit(walk));
    if (contact.found) return hit(ray, contact, walk.visited);
    return miss(ray, walk.visited);
}

void walk_on(Ray ray_a, Ray ray_b, inout Traversal a, inout Traversal b)
{
    while (is_active(a) || is_active(b))
    {
        real front_a = front_of(a, 0), front_b = front_of(b, 1);
        advance(a, gets_behind(ray_a, a, front_a), top);
        advance(b, gets_behind(ray_b, b, front_b), top);
    }
}

void trace_pair(Ray ray_a, Ray ray_b, out TraceResult result_a, out TraceResult result_b)
{
    Traversal a = start_traversal(ray_a, 0), b = start_traversal(ray_b, 0);
    real2    empty = empty_interval(0); // in front of everything there is one
    stop_at(a, empty.x);
    stop_at(b, empty.x);
    walk_on(ray_a, ray_b, a, b);
    skip_to(a, min(SKIP_LEVEL, top), empty.y);
    skip_to(b, min(SKIP_LEVEL, top), empty.y);
    a.t_stop = a.grid.t_end;
    b.t_stop = b.grid.t_end;
    walk_on(ray_a, ray_b, a, b);
    result_a = finish(ray_a, a, 0);
    result_b = finish(ray_b, b, 1);
}
