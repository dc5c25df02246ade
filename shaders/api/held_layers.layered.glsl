// held_layers.glsl where there are several.
#include "layout/load_layers.glsl"

vec2 held_depths(ivec2 pixel, float depth, uint gradient)
{
    vec2 held = held_depths(pixel, 0, depth, gradient);
    for (int layer = 1; layer < LAYERS; ++layer)
    {
        uvec2 words   = load_layer(pixel, layer);
        float deeper  = uintBitsToFloat(words.x);
        vec2  further = held_depths(pixel, layer, deeper, words.y);
        if (deeper > 0.0) held = vec2(max(held.x, further.x), min(held.y, further.y));
    }
    return held;
}
