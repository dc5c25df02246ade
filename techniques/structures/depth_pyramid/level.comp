// A level of the depth pyramid, two cells side by side an invocation: fewer reads and writes.
#include "make_cells.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    ivec2 cell = ivec2(2, 1) * ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(cell, level_size(level)))) store_cells(cell, two_cells(cell));
}
