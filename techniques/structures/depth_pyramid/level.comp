// A level of the depth pyramid, two cells side by side an invocation: fewer reads and writes.
#include "make_cells.glsl"

void main()
{
    ivec2 cell = ivec2(2, 1) * ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(cell, level_size(level)))) store_cells(cell, two_cells(cell));
}
