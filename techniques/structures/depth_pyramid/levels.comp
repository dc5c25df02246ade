// Up to five levels of the depth pyramid, for GPUs, where dispatches that wait for each other cost more than the work. A workgroup has a square of 16 x 16
// cells of the first level, an invocation four of them; of each level above a quarter of the invocations before has one.
#include "cells_of_cells.glsl"
#include "cells_of_pixels.glsl"
#include "layout/store_cell.glsl"

#define SIDE 8
layout(local_size_x = SIDE, local_size_y = SIDE) in;
layout(push_constant, scalar) uniform Push { int first_level, last_level; };

shared uvec2 made[SIDE * SIDE];

// Also beside the end of an odd row, as where pairs are stored.
void store_made(ivec2 cell, int level, uvec2 words)
{
    ivec2 size = level_size(level);
    if (cell.y < size.y && cell.x < size.x + (size.x & 1)) store_cell(cell, level, words);
}

// Two cells side by side of the first level, stored; empty where the level ends.
uvec4 stored_pair(ivec2 cell)
{
    ivec2 size = level_size(first_level);
    if (any(greaterThanEqual(cell, size))) return uvec4(empty_cell, empty_cell);
    uvec4 cells = first_level == 1 ? two_cells_of_pixels(cell) : two_cells_of_cells(cell, first_level);
    store_pair(pair_index(cell, pyramid_root >> first_level), cells);
    return uvec4(cells.xy, cell.x + 1 < size.x ? cells.zw : empty_cell);
}

void main()
{
    ivec2 lane = ivec2(gl_LocalInvocationID.xy), group = ivec2(gl_WorkGroupID.xy), first = 2 * (SIDE * group + lane);
    uvec4 upper = stored_pair(first), lower = stored_pair(first + ivec2(0, 1));
    uvec2 own   = cell_of_quarters(upper, lower);
    for (int level = first_level + 1; level <= last_level; ++level)
    {
        int side = SIDE >> (level - first_level - 1), place = SIDE * lane.y + lane.x;
        if (all(lessThan(lane, ivec2(side))))
        {
            store_made(side * group + lane, level, own);
            made[place] = own;
        }
        barrier();
        if (all(lessThan(2 * lane, ivec2(side))))
        {
            int quarter = 2 * place;
            own = cell_of_quarters(uvec4(made[quarter], made[quarter + 1]), uvec4(made[quarter + SIDE], made[quarter + SIDE + 1]));
        }
        barrier();
    }
}
