// What a plane and the solid up to its far side hold, rounded outward: wider than any rounding of the hit test on the pixel itself.
#include "surfaces/plane/stored.glsl"
#include "surfaces/plane_sides/far_side.glsl"
const float held_margin = 1.0 / 65536.0;

vec2 usable_gradient(uint words)
{
    vec2 stored = unpack_gradient(words);
    return has_plane(stored) ? stored : vec2(0);
}

Held held_by(ivec2 pixel, int layer, float depth, uint gradient)
{
    uvec2 behind       = load_far_side(pixel, layer);
    float far          = uintBitsToFloat(behind.x);
    vec2  far_gradient = usable_gradient(behind.y);
    Held  held;
    held.gradient = usable_gradient(gradient);
    vec2  tilts   = abs(held.gradient) + abs(far_gradient);
    float margin  = (depth + tilts.x + tilts.y) * held_margin;
    float back    = far - dot(abs(far_gradient - held.gradient), vec2(held_reach_px)); // over the plane's gradient
    held.front    = depth + margin;
    held.back     = (far > 0.0 ? min(depth, back) : depth) - margin;
    return held;
}
