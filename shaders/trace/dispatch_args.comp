// The launches of a list of rays that other passes have filled and counted.
#include "trace/ray_launches.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };

void main()
{
    store_ray_launches(ray_count);
}
