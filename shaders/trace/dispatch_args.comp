// Turns a number of items into the size of the launch that works on them.
#include "layout/numbers.h"
#include "layout/frame_shared.h"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) readonly buffer ItemCount { uint item_count; };
layout(set = 0, binding = 1, scalar) writeonly buffer Launch { uvec3 groups; };
layout(constant_id = CONSTANT_ITEMS_PER_GROUP) const int items_per_group = 1;

void main()
{
    uint count = (item_count + items_per_group - 1) / items_per_group;
    groups     = uvec3(min(count, LAUNCH_ROW_GROUPS), (count + LAUNCH_ROW_GROUPS - 1) / LAUNCH_ROW_GROUPS, 1);
}
