#ifndef SSRLAB_WORK_GROUP
#define SSRLAB_WORK_GROUP
#include "shared.h"

// Number of this workgroup in a launch that launch.comp folded into rows of MAX_GROUPS_X.
uint work_group()
{
    return gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x;
}
#endif
