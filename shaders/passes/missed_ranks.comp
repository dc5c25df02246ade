// Which of a block's missed rays is followed: the one of the least rank.
#include "passes/missed_rays.glsl"

layout(set = 0, binding = 56, scalar) buffer MissRanks { uint ranks[]; };

void main()
{
    uint     index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    WorldRay missed;
    if (!is_missed(index, missed)) return;
    ivec2 pixel = unpack_pixel(ray_pixel(index));
    atomicMin(ranks[miss_block(pixel)], miss_rank(pixel, index % uint(rays_per_pixel)));
}
