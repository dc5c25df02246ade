// Lists the missed rays, and finds which ray of each block is followed: the one of the least rank. Other rays keep what
// they have.
#include "passes/missed_rays.glsl"
#include "world/append.glsl"
#include "trace/hit_list.glsl"
#include "passes/given_light.glsl"

layout(set = 0, binding = 54, scalar) writeonly buffer MissedRays { uint missed_rays[]; };
layout(set = 0, binding = 55, scalar) writeonly buffer MissedLights { GivenLight lights[]; };
layout(set = 0, binding = 56, scalar) buffer MissRanks { uint ranks[]; };

// Did this ray of the list find no surface that is seen? One that ends where it begins has no direction, and does not count.
bool is_missed(uint index)
{
    PackedRay ray = packed_ray(index);
    vec3 along_vs = direction_vs(ray);
    return given_light(index).distance_m < 0.0 && unpack_status(packed_hit(index).pixel) != TRACE_HIT && dot(along_vs, along_vs) > 0.5 &&
           reflects(unpack_pixel(ray.pixel));
}

void main()
{
    uint index  = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    bool listed = index < ray_count, missed = listed && is_missed(index);
    uint place  = append_place(missed);
    if (listed) lights[index] = given_light(index);
    if (!missed) return;
    missed_rays[place] = index;
    ivec2 pixel        = unpack_pixel(ray_pixel(index));
    atomicMin(ranks[miss_block(pixel)], miss_rank(pixel, index % uint(rays_per_pixel)));
}
