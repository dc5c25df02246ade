// Up to five levels of the depth pyramid, for GPUs, where dispatches that wait for each other cost more than the work. A workgroup has a square of 16 x 16
// cells of the first level, an invocation four of them; of each level above a quarter of the invocations before has one.
#include "make_cells.glsl"
#include "layout/store_cell.glsl"

#define SIDE 8 // of the workgroup

shared uvec2 made[SIDE * SIDE];

// Also beside the end of an odd row, as where pairs are stored.
void store_made(ivec2 cell, int above, uvec2 words)
{
    ivec2 cells = level_size(above);
    if (cell.y < cells.y && cell.x < cells.x + (cells.x & 1)) store_cell(cell, above, words);
}

// Two cells side by side of the first level, stored; empty where the level ends.
uvec4 stored_pair(ivec2 cell)
{
    ivec2 size = level_size(level);
    if (any(greaterThanEqual(cell, size))) return uvec4(0);
    uvec4 cells = two_cells(cell);
    store_cells(cell, cells);
    return uvec4(cells.xy, cell.x + 1 < size.x ? cells.zw : uvec2(0));
}

void main()
{
    ivec2 lane = ivec2(gl_LocalInvocationID.xy), group = ivec2(gl_WorkGroupID.xy), first = 2 * (SIDE * group + lane);
    uvec4 upper = stored_pair(first), lower = stored_pair(first + ivec2(0, 1));
    uvec2 made_here = cell_of(false, ivec2(0), upper, lower);
    for (int above = level + 1; above <= last_level; ++above)
    {
        int side = SIDE >> (above - level - 1), place = SIDE * lane.y + lane.x;
        if (all(lessThan(lane, ivec2(side))))
        {
            store_made(side * group + lane, above, made_here);
            made[place] = made_here;
        }
        barrier();
        if (all(lessThan(2 * lane, ivec2(side))))
        {
            int quarter = 2 * place;
            made_here = cell_of(false, ivec2(0), uvec4(made[quarter], made[quarter + 1]), uvec4(made[quarter + SIDE], made[quarter + SIDE + 1]));
        }
        barrier();
    }
}
