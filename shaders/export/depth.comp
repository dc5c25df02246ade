// Puts the host's depth where the other passes read it. Run it first in each frame.
#include "api/view.glsl"
#define DEPTH_BINDING 3
#define PLANES_BINDING 6
#include "layout/store_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1, scalar) readonly buffer HostDepth { float host_depths[]; }; // row by row

// near_m / distance; for an orthographic view (far_m - distance) / (far_m - near_m). 0 where there is no surface.
// A host with a depth texture, or with another convention, changes this function.
float host_depth(ivec2 pixel) { return host_depths[pixel.y * size_px.x + pixel.x]; }

#include "export/host_gradients.glsl"

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    float depth  = host_depth(pixel);
    bool  usable = depth > 0.0 && depth <= 1.0;
    store_depth(pixel, usable ? depth : BACKGROUND_DEPTH, usable ? host_gradient(pixel) : 0);
}
