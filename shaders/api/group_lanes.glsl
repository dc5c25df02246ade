// For the passes of a structure per ray group, RAY_GROUP_INVOCATIONS invocations a workgroup: those that share a group. On a CPU device each has a group
// of its own, GROUP_LANES == 1. On a GPU several lanes of a subgroup work on one, so that they wait for memory together. Whoever asks other lanes must do
// so where the whole subgroup is: loops go on while any_in_subgroup().
#include "layout/frame_shared.h"
#include "layout/workgroups.glsl"
#if GROUP_LANES > 1
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_shuffle : require

int ray_group_in_workgroup() { return int((gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID) / GROUP_LANES); }
int group_lane() { return int(gl_SubgroupInvocationID % GROUP_LANES); }
bool any_in_subgroup(bool own) { return subgroupAny(own); }

bool any_group_lane(bool own)
{
    uint any = uint(own);
    for (int other = 1; other < GROUP_LANES; other *= 2) any |= subgroupShuffleXor(any, other);
    return any != 0;
}

uint sum_of_group_lanes(uint own)
{
    for (int other = 1; other < GROUP_LANES; other *= 2) own += subgroupShuffleXor(own, other);
    return own;
}

#define LEAST_OF_GROUP_LANES(TYPE)                                                                                 \
    TYPE least_of_group_lanes(TYPE least)                                                                          \
    {                                                                                                              \
        for (int other = 1; other < GROUP_LANES; other *= 2) least = min(least, subgroupShuffleXor(least, other)); \
        return least;                                                                                              \
    }
#else
int  ray_group_in_workgroup() { return int(gl_LocalInvocationID.x); }
int  group_lane() { return 0; }
bool any_in_subgroup(bool own) { return own; }
bool any_group_lane(bool own) { return own; }
uint sum_of_group_lanes(uint own) { return own; }
#define LEAST_OF_GROUP_LANES(TYPE) TYPE least_of_group_lanes(TYPE least) { return least; }
#endif

int ray_group() { return int(work_group() * (RAY_GROUP_INVOCATIONS / GROUP_LANES)) + ray_group_in_workgroup(); }
