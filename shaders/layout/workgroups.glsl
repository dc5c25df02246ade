// Which part of a list a workgroup takes.
#include "layout/numbers.h"

// A launch is folded into rows. A CPU device gives the upper rows to one thread and the lower rows to another: neighbours in a list go to different
// threads, since they cost about the same.
uint folded_group()
{
    uint upper = (gl_NumWorkGroups.y + 1) / 2;
    uint row   = gl_WorkGroupID.y < upper ? 2 * gl_WorkGroupID.y : 2 * (gl_WorkGroupID.y - upper) + 1;
    return row * LAUNCH_ROW_GROUPS + gl_WorkGroupID.x;
}

// Number of this workgroup in a launch over a list.
#define work_group() folded_group()
