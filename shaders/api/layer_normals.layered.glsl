// layer_normals.glsl in several layers.
#include "layout/load_layers.glsl"

real3 fetch_normal(ivec2 pixel, int layer) { return layer > 0 ? real3(load_layer_normal(pixel, layer)) : fetch_normal(pixel); }
