// The launch that covers a list: rows of workgroups, because devices limit how long one may be.
#include "layout/numbers.h"

uvec3 launch_of(uint items, uint items_per_workgroup)
{
    uint groups = (items + items_per_workgroup - 1) / items_per_workgroup;
    return uvec3(min(groups, LAUNCH_ROW_GROUPS), (groups + LAUNCH_ROW_GROUPS - 1) / LAUNCH_ROW_GROUPS, 1);
}
