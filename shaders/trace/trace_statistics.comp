// How the rays of the pixels that reflect ended, for the frame's plan.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/reflecting.glsl"
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 10, scalar) buffer TraceStatistics // struct TraceCounts of trace/counts.h
{
    uint rays;
    uint hits;
    uint mirror_hits;
};

void main()
{
    uint index  = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    bool traced = index < ray_count && reflects(unpack_pixel(ray_pixel(index)));
    uint found  = traced ? packed_hit(index).pixel : 0;
    bool hit    = traced && unpack_status(found) == TRACE_HIT;
    bool mirror = hit && unpack_layer(found) == 0 && reflects(unpack_pixel(found));
    uint traced_count = subgroupAdd(uint(traced)), hit_count = subgroupAdd(uint(hit)), mirror_count = subgroupAdd(uint(mirror));
    if (!subgroupElect()) return;
    atomicAdd(rays, traced_count);
    atomicAdd(hits, hit_count);
    atomicAdd(mirror_hits, mirror_count);
}
