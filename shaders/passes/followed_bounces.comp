// Lists the rays that go on from what followed rays met, where that reflects.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"
#include "world/append.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 50, scalar) readonly buffer MetLaunch { ListLaunch launch; };
layout(set = 0, binding = 54, scalar) readonly buffer NextRays { NextRay next[]; };
layout(set = 0, binding = 57, scalar) writeonly buffer WorldRays { WorldRay onward[]; };
layout(set = 0, binding = 58, scalar) writeonly buffer OnwardSources { uint sources[]; }; // places of the rays before

void main()
{
    uint number  = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    bool goes_on = number < launch.count && next[number].weight != vec3(0);
    uint place   = append_place(goes_on);
    if (!goes_on) return;
    onward[place]  = next[number].ray;
    sources[place] = number;
}
