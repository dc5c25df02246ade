// Level 1 of the depth pyramid, from pixels.
#include "make_cells.glsl"

void main() { if (all(lessThan(own, size))) store_cells(own, two_cells_of_pixels(own)); }
