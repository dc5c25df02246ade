// far_side.glsl where there are several.
#include "layout/load_layers.glsl"
#include "surfaces/plane/solid.glsl"

// What the layer shows behind this one, if the solid behind this one ends there; else background.
uvec2 load_far_side(ivec2 pixel, int layer)
{
    uvec2 words = layer + 1 < LAYERS ? load_layer(pixel, layer + 1) : uvec2(0);
    return uintBitsToFloat(words.x) == load_solid(pixel, layer) ? words : uvec2(0);
}

// Does the layer show where the solid behind the one before ends?
bool is_far_side(ivec2 pixel, int layer) { return layer > 0 && uintBitsToFloat(load_far_side(pixel, layer - 1).x) > 0.0; }
