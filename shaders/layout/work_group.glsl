#ifndef SSRLAB_WORK_GROUP
#define SSRLAB_WORK_GROUP
#include "layout/shared.h"

// Number of this workgroup in a launch that launch.comp folded into rows. A device that is a CPU hands the upper rows to one thread and the lower ones
// to another: what they do lies side by side, since neighbours in a list cost about the same (docs/performance.md).
uint work_group()
{
    uint upper = (gl_NumWorkGroups.y + 1) / 2, y = gl_WorkGroupID.y;
    uint row   = y < upper ? 2 * y : 2 * (y - upper) + 1;
    return row * LAUNCH_ROW_GROUPS + gl_WorkGroupID.x;
}
#endif
