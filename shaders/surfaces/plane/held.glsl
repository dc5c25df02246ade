// What a plane holds, rounded outward: wider than any rounding of the hit test on the pixel itself.
#include "surfaces/plane/stored.glsl"
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

// The most that the pixel holds above a plane of this gradient through 0 at its centre.
const bool level_fronts = false;
float front_above(Held held, vec2 gradient) { return held.front + dot(abs(held.gradient - gradient), vec2(held_reach_px)); }

// A number that is larger the nearer the back is: the depth of the back, at its farthest.
float back_key(Held held, float depth) { return held.back - (abs(held.gradient.x) + abs(held.gradient.y)) * held_reach_px; }

float key_of_back(float back) { return back; }

bool passes_behind(real key, real z_near) { return z_near < key; }
