// Turns the number of rays into the size of the launch that traces them.
#include "shared.h"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) readonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 1, scalar) writeonly buffer Launch { uvec3 groups; };

void main()
{
    uint count = (ray_count + RAYS_PER_GROUP - 1) / RAYS_PER_GROUP;
    groups     = uvec3(min(count, MAX_GROUPS_X), (count + MAX_GROUPS_X - 1) / MAX_GROUPS_X, 1);
}
