// Up to seven levels of the depth pyramid, for GPUs, where dispatches that wait for each other cost more than the work. A workgroup has a square of 64 x 64
// cells of the first level, an invocation 4 x 4 of them and what lies above; from the fourth level on, a quarter of the invocations before has a cell.
#include "make_cells.glsl"
#include "layout/store_cell.glsl"

#define SIDE 16 // of the workgroup

layout(local_size_x = SIDE, local_size_y = SIDE) in;

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
    ivec2 lane = ivec2(gl_LocalInvocationID.xy), group = ivec2(gl_WorkGroupID.xy);
    uvec2 quarters[4]; // cells of the second level
    for (int i = 0; i < 4; ++i)
    {
        ivec2 cell  = 2 * (SIDE * group + lane) + ivec2(i & 1, i >> 1);
        uvec4 upper = stored_pair(2 * cell), lower = stored_pair(2 * cell + ivec2(0, 1));
        quarters[i] = cell_of(false, ivec2(0), upper, lower);
        if (level < last_level) store_made(cell, level + 1, quarters[i]);
    }
    uvec2 made_here = cell_of(false, ivec2(0), uvec4(quarters[0], quarters[1]), uvec4(quarters[2], quarters[3]));
    for (int above = level + 2; above <= last_level; ++above)
    {
        int side = SIDE >> (above - level - 2), place = SIDE * lane.y + lane.x;
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
