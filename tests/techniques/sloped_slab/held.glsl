#include "surfaces/plane/stored.glsl"
const float held_margin = 1.0 / 65536.0; // wider than any rounding of the hit test

Held held_by(ivec2 pixel, int layer, float depth, uint gradient)
{
    vec2 stored = unpack_gradient(gradient);
    Held held;
    held.gradient = has_plane(stored) ? stored : vec2(0);
    float margin  = (depth + abs(held.gradient.x) + abs(held.gradient.y) + abs(float(slab_shift))) * held_margin;
    held.front    = depth + margin;
    held.back     = float(slab_back(real(depth))) - margin;
    return held;
}

#include "surfaces/plane/sloped.glsl"
