// Reads depth, for passes. Techniques read cells (layout/load_cell.glsl).
#include "layout/depth_words.glsl"
#include "layout/float_texels.glsl"

LOADED_FLOATS(DEPTH_BINDING, depth_words)

float load_depth(ivec2 pixel) { return LOAD_TEXEL(depth_words, depth_word(pixel)).x; }
