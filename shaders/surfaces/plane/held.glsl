// What a plane holds, rounded outward: wider than any rounding of the hit test on the pixel itself.
#include "surfaces/plane/stored.glsl"
#include "surfaces/plane/solid.glsl"
const float held_margin = 1.0 / 65536.0;

Held held_by(ivec2 pixel, int layer, float depth, uint gradient)
{
    vec2 stored = unpack_gradient(gradient);
    Held held;
    held.gradient = has_plane(stored) ? stored : vec2(0);
    float tilt    = abs(held.gradient.x) + abs(held.gradient.y), margin = (depth + tilt) * held_margin;
    float back    = has_plane(stored) ? depth - float(plane_tolerance(real(depth))) : float(slab_back(real(depth)));
    float solid   = load_solid(pixel, layer);
    held.front    = depth + margin;
    // The solid ends at a level depth, which is lowest above the plane where the plane is nearest.
    held.back = min(back, solid - tilt * held_reach_px) - margin;
    return held;
}
