// Where what each pixel shows was in the frame before, minus where it is now; in pixels, without the jitter of either frame. Every
// motion here is rigid, so depth and object say it exactly, and the rasteriser needs no second position.
#include "api/view.glsl"
#define DEPTH_BINDING 1
#include "layout/load_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D object_image;
layout(set = 0, binding = 3, rg32f) uniform writeonly image2D motion_image;
layout(set = 0, binding = 4, scalar) uniform PreviousView
{
    vec2 previous_focal_px, previous_centre_px;
    vec2 jitter_px; // of this frame
};
layout(set = 0, binding = 5, scalar) readonly buffer Objects { mat4 to_previous_vs[]; }; // by object; 0: what stands still

// At infinity only the camera's turns count; in an orthographic view every pixel shows the same point there.
vec4 position_vs(vec2 position_px, float depth)
{
    if (depth > 0.0) return vec4(px_to_vs(vec3(position_px, depth)), 1);
    return vec4(orthographic != 0 ? vec2(0) : px_to_slope(position_px), -1, 0);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    vec2  centre   = vec2(pixel) + 0.5;
    float depth    = load_depth(pixel);
    uint  object   = depth > 0.0 ? imageLoad(object_image, pixel).x : 0;
    vec3  previous = (to_previous_vs[object] * position_vs(centre, depth)).xyz;
    vec2  slope    = orthographic != 0 ? previous.xy : previous.xy / -previous.z;
    vec2  moved    = previous_centre_px + slope * previous_focal_px * vec2(1, -1) - (centre - jitter_px);
    if (orthographic != 0 && depth <= 0.0) moved = vec2(0);
    // What was behind the camera was nowhere.
    if (orthographic == 0 && previous.z >= 0.0) moved = vec2(uintBitsToFloat(0x7FC00000u));
    imageStore(motion_image, pixel, vec4(moved, 0, 0));
}
