// Which part of a list a workgroup takes.
#include "layout/numbers.h"

// A launch is folded into rows. A CPU device gives the upper rows to one thread and the lower rows to another: neighbours in a list go to different
// threads, since they cost about the same.
uint unfold_group(uvec2 group, uint rows)
{
    uint upper = (rows + 1) / 2;
    uint row   = group.y < upper ? 2 * group.y : 2 * (group.y - upper) + 1;
    return row * LAUNCH_ROW_GROUPS + group.x;
}

// Number of this workgroup in a launch over a list.
#define work_group() unfold_group(gl_WorkGroupID.xy, gl_NumWorkGroups.y)
