// Reads depth, for passes. Techniques read cells (layout/load_cell.glsl).
#ifndef SSRLAB_LOAD_DEPTH
#define SSRLAB_LOAD_DEPTH
#include "layout/depth_words.glsl"

layout(set = 0, binding = DEPTH_BINDING, r32f) uniform readonly imageBuffer depth_words;

float load_depth(ivec2 pixel) { return imageLoad(depth_words, depth_word(pixel)).x; }
#endif
