// The walk of techniques/dda, two rays at a time and two pixels of each in one iteration, in a picture mirrored so that they run forward.
#include "api/forward_traversal.glsl"
#include "api/test_pixel.glsl"

// In pixels, level 0.
void visit(Ray ray, inout Traversal walk, int own_lane)
{
    bool  goes     = is_active(walk);
    lane           = goes ? own_lane : 2;
    real2 t_border = border_t(walk.forward, walk.grid, walk.corner);
    real  t_out    = exit_t(walk.grid, t_border);
    Contact contact = test_pixel(ray, walk.grid, pixel_of(walk), walk.t, t_out);
    bool  leaves   = goes && !contact.found;
    ivec2 next     = next_corner(walk.corner, 1, t_border, t_out);
    walk.t         = leaves ? t_out : walk.t;
    walk.corner    = leaves ? next : walk.corner;
    walk.level     = goes && contact.found ? -1 : walk.level;
    if (goes) walk.contact = contact;
    walk.visited += int(goes);
}

TraceResult finish(Ray ray, Traversal walk, int own_lane)
{
    lane = own_lane;
    return result_of(ray, walk);
}

void trace_pair(Ray ray_a, Ray ray_b, out TraceResult result_a, out TraceResult result_b)
{
    Traversal a = start_traversal(ray_a, 0), b = start_traversal(ray_b, 0);
    while (is_active(a) || is_active(b))
    {
        visit(ray_a, a, 0);
        visit(ray_b, b, 1);
        visit(ray_a, a, 0);
        visit(ray_b, b, 1);
    }
    result_a = finish(ray_a, a, 0);
    result_b = finish(ray_b, b, 1);
}
