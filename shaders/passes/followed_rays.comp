// Lists the ray that each block follows.
#include "passes/missed_rays.glsl"
#include "world/append.glsl"

layout(set = 0, binding = 50, scalar) readonly buffer MissedLaunch { ListLaunch launch; };
layout(set = 0, binding = 54, scalar) readonly buffer MissedRays { uint missed_rays[]; };
layout(set = 0, binding = 56, scalar) readonly buffer MissRanks { uint ranks[]; };
layout(set = 0, binding = 57, scalar) writeonly buffer WorldRays { WorldRay followed[]; };
layout(set = 0, binding = 58, scalar) writeonly buffer FollowedPlaces { uint places[]; }; // of each block, in the list

void main()
{
    uint  number  = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    uint  index   = number < launch.count ? missed_rays[number] : 0;
    ivec2 pixel   = unpack_pixel(ray_pixel(index));
    int   block   = miss_block(pixel);
    bool  follows = number < launch.count && ranks[block] == miss_rank(pixel, index % uint(rays_per_pixel));
    uint  place   = append_place(follows);
    if (!follows) return;
    followed[place] = missed_ray(index);
    places[block]   = place;
}
