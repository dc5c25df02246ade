// Fetches of the layers behind the first one; with LAYERS > 1.
#extension GL_EXT_control_flow_attributes : require
#include "layout/load_layers.glsl"

// layer: 0, 1, ...; not counted.
real3 fetch_normal(ivec2 pixel, int layer) { return layer > 0 ? real3(load_layer_normal(pixel, layer)) : fetch_normal(pixel); }

// As fetch_pixel(), of a layer behind the first; counted.
uvec2 fetch_layer(ivec2 pixel, int layer)
{
    count_depth_fetch();
    return load_layer(pixel, layer);
}
