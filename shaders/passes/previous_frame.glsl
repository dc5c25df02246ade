// The frame before this one as its history keeps it, and how surfaces moved since (framework/frame/history_images.h). After view.glsl and
// reflecting.glsl. Positions on the image are without jitter; _pvs is the previous frame's view space.

layout(set = 0, binding = 40, scalar) uniform PreviousView
{
    vec2  previous_focal_px, previous_centre_px;
    vec2  jitter_px; // of this frame
    vec2  previous_jitter_px;
    float previous_near_m, previous_far_m;
    int   takes_history; // 0: the frame is still and repeats itself
    int   stands_still;  // camera and all objects; there may be jitter
};
layout(set = 0, binding = 41, scalar) readonly buffer Objects { mat4 to_previous_vs[]; }; // by object; 0: what stands still
layout(set = 0, binding = 42, r32ui) uniform readonly uimage2D object_image;
layout(set = 0, binding = 43, r32ui) uniform readonly uimage2D gradient_image;
layout(set = 0, binding = 44, r32f) uniform readonly image2D previous_depth_image;
layout(set = 0, binding = 45, r32ui) uniform readonly uimage2D previous_gradient_image;
layout(set = 0, binding = 46, rgba32f) uniform readonly image2D previous_normal_image;

// In place of the object that a ray hit.
const float hit_unknown = -1.0, hit_nothing = -2.0;

// framework/core/plane_gradient.h packs it; NaN: the pixel has no plane.
vec2 unpacked_gradient(uint words) { return uintBitsToFloat(uvec2(words & 0xFFFF0000u, words << 16)); }

// Depth is linear on screen, so a pixel's plane says it at any position. Extrapolation to less than half or more than twice is none.
float depth_on_plane(float depth, uint gradient, vec2 from_centre_px)
{
    float there = depth + dot(unpacked_gradient(gradient), from_centre_px);
    return there >= 0.5 * depth && there <= 2.0 * depth ? there : depth;
}

vec3 carried_pvs(vec3 position_vs, uint object) { return (to_previous_vs[object] * vec4(position_vs, 1)).xyz; }

vec3 turned_pvs(vec3 direction_vs, uint object) { return mat3(to_previous_vs[object]) * direction_vs; }

bool in_image(vec2 position_px) { return all(greaterThanEqual(position_px, vec2(0))) && all(lessThan(position_px, vec2(size_px))); }

// Of what the previous frame shows at a position; 0 or less: nothing.
float previous_depth(vec2 px)
{
    vec2 drawn_px = px + previous_jitter_px;
    if (!in_image(drawn_px)) return 0.0;
    ivec2 pixel = ivec2(drawn_px);
    float depth = imageLoad(previous_depth_image, pixel).x;
    return depth_on_plane(depth, imageLoad(previous_gradient_image, pixel).x, drawn_px - vec2(pixel) - 0.5);
}

vec3 previous_normal_pvs(vec2 px)
{
    vec2 drawn_px = px + previous_jitter_px;
    return in_image(drawn_px) ? imageLoad(previous_normal_image, ivec2(drawn_px)).xyz : vec3(0);
}

vec2 previous_px_to_slope(vec2 px) { return (px - previous_centre_px) / previous_focal_px * vec2(1, -1); }

float previous_depth_to_distance(float depth)
{
    return orthographic == 0 ? previous_near_m / depth : previous_far_m - depth * (previous_far_m - previous_near_m);
}

vec3 previous_px_to_pvs(vec3 px_depth)
{
    float distance_m = previous_depth_to_distance(px_depth.z);
    vec2  slope      = previous_px_to_slope(px_depth.xy);
    return vec3(orthographic == 0 ? slope * distance_m : slope, -distance_m);
}
