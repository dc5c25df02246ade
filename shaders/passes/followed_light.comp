// Adds to the light of what followed rays met what that reflects: what the next ray met, or the environment.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"
#include "passes/environment_lobe.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 54, scalar) readonly buffer NextRays { NextRay next[]; };
layout(set = 0, binding = 58, scalar) readonly buffer WorldHits { WorldHit met[]; };
layout(set = 0, binding = 59, scalar) buffer WorldLight { vec3 light[]; };
layout(set = 0, binding = 60, scalar) readonly buffer OnwardLight { vec3 onward_light[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= count || next[index].weight == vec3(0)) return;
    vec3 along_vs  = mat3(world_to_view) * next[index].ray.direction_ws;
    bool meets     = met[index].triangle < WALK_UNFINISHED;
    vec3 reflected = meets ? onward_light[index] : environment_lobe(along_vs, along_vs, next[index].ray.roughness);
    light[index] += next[index].weight * reflected;
}
