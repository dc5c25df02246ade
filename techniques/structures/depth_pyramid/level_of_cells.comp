// A level of the depth pyramid, from the level below.
#include "make_cells.glsl"

void main() { if (all(lessThan(own, size))) store_cells(own, two_cells_of_cells(own)); }
