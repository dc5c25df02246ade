// A level of the depth pyramid, from the level below.
#include "cells_of_cells.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { int level; };

void main()
{
    ivec2 cell = ivec2(2, 1) * ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(cell, level_size(level)))) store_pair(pair_index(cell, pyramid_root >> level), two_cells_of_cells(cell, level));
}
