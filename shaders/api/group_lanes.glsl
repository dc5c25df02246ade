// The invocations that share a ray group. A CPU device has one for each, GROUP_LANES == 1; on a GPU several lanes of a subgroup work on a group, so that they
// wait for memory together. Whoever asks other lanes must do so where the whole subgroup is: loops go on while any_in_subgroup().
#ifndef SSRLAB_GROUP_LANES
#define SSRLAB_GROUP_LANES
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

#define LEAST_OF_GROUP_LANES(TYPE)                                                             \
    TYPE least_of_group_lanes(TYPE least)                                                      \
    {                                                                                    \
        for (int other = 1; other < GROUP_LANES; other *= 2) least = min(least, subgroupShuffleXor(least, other)); \
        return least;                                                                    \
    }
#else
int  ray_group_in_workgroup() { return int(gl_LocalInvocationID.x); }
int  group_lane() { return 0; }
bool any_in_subgroup(bool own) { return own; }
bool any_group_lane(bool own) { return own; }
uint sum_of_group_lanes(uint own) { return own; }
#define LEAST_OF_GROUP_LANES(TYPE) TYPE least_of_group_lanes(TYPE least) { return least; }
#endif
#endif
