// What a pixel holds, for structures: they must know where no ray can meet it.
#include "api/camera.glsl"
#include "api/slab.glsl"

struct Held
{
    vec2  gradient;    // of a plane through 0 at the pixel's centre, from one pixel to the next
    float front, back; // all that the pixel holds lies in these heights above that plane (depths, where the gradient is 0)
};

// How far from its centre a ray that is in a pixel may be on each axis, with rounding.
const float held_reach_px = 0.5 + 1.0 / 64;

// gradient: the second word of a pixel with its plane (layout/plane_places.glsl).
#include "surface/held.glsl"

// The nearest and the farthest depth that the pixel holds in one layer.
vec2 held_depths(ivec2 pixel, int layer, float depth, uint gradient)
{
    Held  held   = held_by(pixel, layer, depth, gradient);
    float spread = (abs(held.gradient.x) + abs(held.gradient.y)) * held_reach_px;
    return vec2(held.front + spread, held.back - spread);
}

#include "api/held_layers.glsl"
