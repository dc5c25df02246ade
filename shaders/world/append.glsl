// Appending to a list that others append to at the same time. After world/rays.glsl.
#include "layout/launch_of.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(set = 0, binding = 61, scalar) buffer AppendedLaunch { ListLaunch appended; };

// The place of what this invocation appends; undefined where it appends nothing. All invocations of a subgroup ask.
uint append_place(bool appends)
{
    uvec4 ballot = subgroupBallot(appends);
    uint  first  = 0;
    if (subgroupElect())
    {
        uint added = subgroupBallotBitCount(ballot);
        first      = atomicAdd(appended.count, added);
        uvec3 launch = launch_of(first + added, RAYS_PER_GROUP);
        atomicMax(appended.groups_x, launch.x);
        atomicMax(appended.groups_y, launch.y);
    }
    return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(ballot);
}
