// Cells of a level, from the level below.
#include "make_cells.glsl"

// Two quarters of a cell side by side: a cell of the level below and its right neighbour, empty where that level ends.
uvec4 load_quarters(ivec2 quarter, int level)
{
    ivec2 source_size = level_size(level - 1);
    bvec3 inside = lessThan(ivec3(quarter, quarter.x + 1), source_size.xyx);
    uvec4 pair   = inside.y ? load_pair(pair_index(quarter, pyramid_root >> (level - 1))) : uvec4(0);
    return uvec4(inside.x ? pair.xy : empty_cell, inside.z ? pair.zw : empty_cell);
}

// Two cells side by side.
uvec4 two_cells_of_cells(ivec2 cell, int level)
{
    const ivec2 next = ivec2(2, 0), below = ivec2(0, 1);
    ivec2 first = 2 * cell;
    return uvec4(cell_of_quarters(load_quarters(first, level), load_quarters(first + below, level)),
                 cell_of_quarters(load_quarters(first + next, level), load_quarters(first + next + below, level)));
}
