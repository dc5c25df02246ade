// The depths that a ray covers between two crossings, rounded outward: x the farthest, y the nearest.
#include "api/depth_interval.glsl"

vec2 covered_depths(Ray ray, Grid grid, real t_in, real t_out)
{
    return vec2(depth_interval(ray, depth_at(ray, t_in), depth_at(ray, t_out)));
}
