// A level of the depth pyramid from the level below.
#include "make_cells.glsl"

uvec2 cell_of_quarters(uvec4 upper, uvec4 lower)
{
    Range range = unite(unite(cell_range(upper.xy), cell_range(upper.zw)), unite(cell_range(lower.xy), cell_range(lower.zw)));
    uvec2 cell  = cell_of_range(range);
    cell.y      = bins_of_quarter(cell, upper.xy) | bins_of_quarter(cell, upper.zw);
    cell.y |= bins_of_quarter(cell, lower.xy) | bins_of_quarter(cell, lower.zw);
    return finished(cell);
}

// Two quarters of a cell side by side: a cell of the level below and its right neighbour, empty where that level ends.
uvec4 load_quarters(ivec2 quarter)
{
    ivec2 source_size = level_size(level - 1);
    bvec3 inside = lessThan(ivec3(quarter, quarter.x + 1), source_size.xyx);
    uvec4 pair   = inside.y ? load_pair(pair_index(quarter, pyramid_root >> (level - 1))) : uvec4(0);
    return uvec4(inside.x ? pair.xy : empty_cell, inside.z ? pair.zw : empty_cell);
}

void main()
{
    if (any(greaterThanEqual(cell, size))) return;
    const ivec2 next = ivec2(2, 0), below = ivec2(0, 1);
    ivec2 first = 2 * cell;
    store_cells(uvec4(cell_of_quarters(load_quarters(first), load_quarters(first + below)),
                      cell_of_quarters(load_quarters(first + next), load_quarters(first + next + below))));
}
