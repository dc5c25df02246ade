// Lists the rays of reflecting pixels that found nothing, as they are, to be traced in the second layer.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "layout/store_ray.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/reflecting.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 10, scalar) buffer DerivedCount { uint derived_count; };
STORED_TEXELS_4(11, DerivedRays)
layout(set = 0, binding = 15, scalar) writeonly buffer DerivedSources { uint derived_source[]; }; // index in the first list

void main()
{
    uint index  = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    bool missed = index < ray_count && unpack_status(packed_hit(index).pixel) != TRACE_HIT && reflects(unpack_pixel(ray_pixel(index)));

    uvec4 ballot = subgroupBallot(missed);
    uint  first  = 0;
    if (subgroupElect()) first = atomicAdd(derived_count, subgroupBallotBitCount(ballot));
    first = subgroupBroadcastFirst(first);
    if (!missed) return;

    uint      derived       = first + subgroupBallotExclusiveBitCount(ballot);
    PackedRay ray           = packed_ray(index);
    derived_source[derived] = index;
    STORE_RAY(DerivedRays, derived, ray);
}
