// The walk of hiz_packets, one ray an invocation.
#include "api/forward_traversal.glsl"

TraceResult trace(Ray ray)
{
    int       top = pyramid_top(), number = 0;
    Traversal walk  = start_traversal(ray, min(start_level, top));
    real2     empty = empty_interval(0);
    stop_at(walk, empty.x);
    do
    {
        while (is_active(walk))
        {
            ivec2 pixel = pixel_of(walk);
            uvec2 words = fetch_cell(pixel, walk.level);
            advance(walk, test_cell(ray, walk.grid, pixel, walk.level, words, walk.t, t_exit(walk)), top);
        }
        skip_to(walk, min(SKIP_LEVEL, top), empty.y);
        ++number;
        empty = empty_interval(number);
        stop_at(walk, empty.x);
    } while (number <= intervals_count && is_open(walk));
    return result_of(ray, walk);
}
