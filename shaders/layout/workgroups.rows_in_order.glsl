// Which part of a list a workgroup takes, in an export: its host dispatches rows that follow each other.
#include "layout/numbers.h"

uint folded_group() { return gl_WorkGroupID.y * LAUNCH_ROW_GROUPS + gl_WorkGroupID.x; }

// Number of this workgroup in a launch over a list.
#define work_group() folded_group()
