// The sizes of the launches that work on a list of rays.
#include "layout/launch_of.glsl"
#include "layout/frame_shared.h"

layout(constant_id = CONSTANT_RAYS_PER_WORKGROUP) const int rays_per_workgroup = RAYS_PER_GROUP; // of a structure's pass per ray group

layout(set = 0, binding = 7, scalar) writeonly buffer RayLaunch { uvec3 ray_launch; };     // the trace, and what follows it
layout(set = 0, binding = 8, scalar) writeonly buffer GroupLaunch { uvec3 group_launch; }; // structures

void store_ray_launches(uint rays)
{
    ray_launch   = launch_of(rays, RAYS_PER_GROUP);
    group_launch = launch_of(rays, rays_per_workgroup);
}
