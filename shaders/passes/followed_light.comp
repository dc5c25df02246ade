// Adds to the light of what followed rays met what that reflects: what the next ray met, or the environment.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"
#include "passes/environment_lobe.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 50, scalar) readonly buffer OnwardLaunch { ListLaunch launch; };
layout(set = 0, binding = 54, scalar) readonly buffer NextRays { NextRay next[]; };
layout(set = 0, binding = 57, scalar) readonly buffer OnwardSources { uint sources[]; };
layout(set = 0, binding = 58, scalar) readonly buffer WorldHits { WorldHit met[]; };
layout(set = 0, binding = 59, scalar) buffer WorldLight { vec3 light[]; };
layout(set = 0, binding = 60, scalar) readonly buffer OnwardLight { vec3 onward_light[]; };

void main()
{
    uint number = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (number >= launch.count) return;
    NextRay ray    = next[sources[number]];
    vec3 along_vs  = mat3(world_to_view) * ray.ray.direction_ws;
    bool meets     = met[number].triangle < WALK_UNFINISHED;
    vec3 reflected = meets ? onward_light[number] : environment_lobe(along_vs, along_vs, ray.ray.roughness);
    light[sources[number]] += ray.weight * reflected;
}
