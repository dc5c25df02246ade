// visits.glsl where visits are recorded.
#include "trace/lanes.glsl"

layout(set = 0, binding = 15, scalar) buffer Visits { uint visit_count; uvec4 visits[]; }; // pixel, level, t_in and t_out as bits of floats

const vec2 whole_cell = vec2(-1);
vec2       visited_t  = whole_cell;

// A pixel (level 0), or a cell of a structure by any of its pixels. The list has one ray, in lane 0.
void record_visit(ivec2 pixel, int level)
{
    if (lane != 0) return;
    uint place = visit_count++;
    if (place < visits.length()) visits[place] = uvec4(uint(pixel.x) | uint(pixel.y) << 16, level, floatBitsToUint(visited_t));
    visited_t = whole_cell;
}
// The interval of which the next visit's pixel is asked.
void note_interval(real t_in, real t_out) { visited_t = vec2(t_in, t_out); }
