// solid_image.glsl in several layers.
#include "layout/load_layers.glsl"
layout(set = 0, binding = 13, r32f) uniform readonly image2D solid_image;

float load_solid_image(ivec2 pixel, int layer) { return layer > 0 ? load_layer_solid(pixel, layer) : imageLoad(solid_image, pixel).x; }
