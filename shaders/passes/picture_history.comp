// Accumulates the picture over the frames of a sequence: temporal anti-aliasing (B. Karis 2014, High-Quality Temporal Supersampling). A pixel moves
// as the nearest surface of the 3 x 3 pixels around it, so that edges move with what is in front; a metal, as what it reflects.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/previous_frame.glsl"
#include "passes/previous_surface.glsl"
#include "passes/history_clamping.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D shaded_image;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D filtered_image;
#ifdef MOVED
layout(set = 0, binding = 6, rg32f) uniform readonly image2D motion_image;
#endif
layout(set = 0, binding = 7, rgba32f) uniform readonly image2D previous_picture_image; // colour, accumulated frames
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D kept_picture_image;    // for the next frame
#ifdef REPROJECTED
layout(set = 0, binding = 9, rgba32f) uniform readonly image2D reprojected_image; // passes/reprojection.comp
#endif

ivec2 around(ivec2 pixel, int i) { return clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), size_px - 1); }

vec2 motion_of_nearest(ivec2 pixel)
{
#ifdef MOVED
    ivec2 nearest = pixel;
    for (int i = 0; i < 9; ++i)
        if (load_depth(around(pixel, i)) > load_depth(nearest)) nearest = around(pixel, i);
    return imageLoad(motion_image, nearest).xy;
#else
    return vec2(0);
#endif
}

// Does the frame before show at this position what one of the pixels around shows now? Jitter alone moves edges by a pixel.
bool shown_before(ivec2 pixel, vec2 px)
{
    if (reject_depth == 0.0) return true;
    float stored = previous_depth(px);
    for (int i = 0; i < 9; ++i)
    {
        ivec2 next = around(pixel, i);
        bool  same = load_depth(next) > 0.0 ? shows_surface(next, imageLoad(object_image, next).x, px) : stored <= 0.0;
        if (same) return true;
    }
    return false;
}

// Of the pixels at -1, 0, 1 and 2 around a position between 0 and 1 (E. Catmull and R. Rom 1974). A bilinear mean would blur with each frame.
vec4 catmull_rom(float t) { return 0.5 * vec4(t * (t * (2.0 - t) - 1.0), t * t * (3.0 * t - 5.0) + 2.0, t * (t * (4.0 - 3.0 * t) + 1.0), t * t * (t - 1.0)); }

vec3 previous_colour(vec2 place_px)
{
    ivec2 first = ivec2(floor(place_px - 0.5));
    vec2  share = place_px - 0.5 - vec2(first);
    vec4  across = catmull_rom(share.x), down = catmull_rom(share.y);
    vec3  sum = vec3(0);
    for (int i = 0; i < 16; ++i)
    {
        ivec2 pixel = clamp(first + ivec2(i % 4, i / 4) - 1, ivec2(0), size_px - 1);
        sum += imageLoad(previous_picture_image, pixel).rgb * across[i % 4] * down[i / 4];
    }
    return max(sum, vec3(0));
}

vec3 clamped_to_neighbours(ivec2 pixel, vec3 value)
{
    vec4 colours[9];
    for (int i = 0; i < 9; ++i) colours[i] = imageLoad(shaded_image, around(pixel, i));
    return clamped_to(colours, 9, vec4(value, 1)).rgb;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    vec4 result    = vec4(imageLoad(shaded_image, pixel).rgb, 1);
    vec2 motion_px = motion_of_nearest(pixel);
#ifdef REPROJECTED
    if (reflects(pixel) && imageLoad(material_image, pixel).a > 0.5) motion_px = imageLoad(reprojected_image, pixel).xy;
#endif
    vec2 place_px = vec2(pixel) + 0.5 + motion_px;
    bool known     = all(lessThan(abs(motion_px), vec2(1e9))) && in_image(place_px); // NaN: it was behind the camera
    if (takes_history != 0 && known && shown_before(pixel, place_px - jitter_px))
    {
        vec3 before = previous_colour(place_px);
        if (history_clamping != history_clamping_off) before = clamped_to_neighbours(pixel, before);
        // A plain mean until there are enough frames for the weight.
        float frames = imageLoad(previous_picture_image, ivec2(place_px)).a;
        result       = vec4(mix(result.rgb, before, min(frames / (frames + 1.0), picture_history_weight)), frames + 1.0);
    }
    imageStore(kept_picture_image, pixel, result);
    imageStore(filtered_image, pixel, vec4(result.rgb, 1));
}
