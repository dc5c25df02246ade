// Lists the rays that go on from what followed rays met, where that reflects. Elsewhere a ray that meets nothing.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 54, scalar) readonly buffer NextRays { NextRay next[]; };
layout(set = 0, binding = 57, scalar) writeonly buffer WorldRays { WorldRay onward[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= count) return;
    WorldRay ray = next[index].ray;
    if (next[index].weight == vec3(0)) ray.t_max = -1.0;
    onward[index] = ray;
}
