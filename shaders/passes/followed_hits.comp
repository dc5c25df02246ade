// Lists the followed rays that met something, with their hits.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"
#include "world/append.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 50, scalar) readonly buffer FollowedLaunch { ListLaunch launch; };
layout(set = 0, binding = 57, scalar) readonly buffer WorldRays { WorldRay followed[]; };
layout(set = 0, binding = 58, scalar) readonly buffer WorldHits { WorldHit hits[]; };
layout(set = 0, binding = 59, scalar) writeonly buffer MetRays { WorldRay met_rays[]; };
layout(set = 0, binding = 60, scalar) writeonly buffer MetHits { WorldHit met_hits[]; };
layout(set = 0, binding = 62, scalar) writeonly buffer MetPlaces { uint met_places[]; }; // of each followed ray

void main()
{
    uint number = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    bool meets  = number < launch.count && hits[number].triangle < WALK_UNFINISHED;
    uint place  = append_place(meets);
    if (!meets) return;
    met_rays[place]    = followed[number];
    met_hits[place]    = hits[number];
    met_places[number] = place;
}
