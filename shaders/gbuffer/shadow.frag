// Depth only; masked texels cast no shadow.
#include "gbuffer/cut_out.glsl"

void main() { discard_cut_out(); }
