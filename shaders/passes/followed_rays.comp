// Lists the ray that each block follows, at the block's place in the list.
#include "passes/missed_rays.glsl"

layout(set = 0, binding = 56, scalar) readonly buffer MissRanks { uint ranks[]; };
layout(set = 0, binding = 57, scalar) writeonly buffer WorldRays { WorldRay followed[]; };

void main()
{
    uint     index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    WorldRay missed;
    if (!is_missed(index, missed)) return;
    ivec2 pixel = unpack_pixel(ray_pixel(index));
    int   block = miss_block(pixel);
    if (ranks[block] == miss_rank(pixel, index % uint(rays_per_pixel))) followed[block] = missed;
}
