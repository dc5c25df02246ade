// What a box holds, rounded outward: wider than any rounding of the hit test on the pixel itself.
#include "api/box.glsl"
const float held_margin = 1.0 / 1048576.0;
#include "surfaces/box/held_front.glsl"

Held held_by(ivec2 pixel, int layer, float depth, uint gradient)
{
    Held held;
    held.gradient = vec2(0);
    held.back     = float(slab_back(real(depth)));
    held.back -= abs(held.back) * held_margin + abs(float(slab_shift)) * held_margin;
    held.front = held_front(depth);
    return held;
}
