// What the history holds of a pixel's reflection, and whether that still is the same reflection. After previous_frame.glsl and pass/parameters.
#include "layout/frame_shared.h"
#include "passes/blocks.glsl"
#include "passes/mean_reflection.glsl"
#include "passes/previous_surface.glsl"

layout(set = 0, binding = 50, rgba32f) uniform readonly image2D reprojected_image;         // passes/reprojection.comp
layout(set = 0, binding = 51, rgba32f) uniform readonly image2D previous_reflection_image; // colour times weight, weight; < 0: reflects nothing
layout(set = 0, binding = 52, rgba32f) uniform readonly image2D previous_facts_image;      // frames in it, ray length, object that was hit
#ifdef BLOCKS
layout(set = 0, binding = 53, r32ui) uniform readonly uimage2D block_pixel_image;
#endif

struct History
{
    vec4  reflection; // colour times weight, weight
    float frames;     // in it
    float share;      // in [0, 1]: how much it is to count, by the ray's length
};

// The pixel's own vector, or at a lower resolution that of its block's pixel with rays.
vec4 own_reprojected(ivec2 pixel)
{
    pixel = clamp(pixel, ivec2(0), size_px - 1);
#ifdef BLOCKS
    uint packed = imageLoad(block_pixel_image, pixel / block_px).x;
    pixel       = packed == NO_PIXEL ? pixel : unpack_pixel(packed);
#endif
    return imageLoad(reprojected_image, pixel);
}

// A miss beside hits is at their border, and moves with the nearest of them.
vec4 reprojected(ivec2 pixel)
{
    vec4 now = own_reprojected(pixel);
    if (now.w != hit_nothing) return now;
    for (int i = 0; i < 9; ++i)
    {
        vec4 next = own_reprojected(pixel + (ivec2(i % 3, i / 3) - 1) * block_px);
        if (next.w >= 0.0 && !isnan(next.x) && (now.w < 0.0 || next.z < now.z)) now = next;
    }
    return now;
}

// Bilinear over the pixels that reflected.
vec4 previous_reflection(vec2 place_px)
{
    ivec2 first = ivec2(floor(place_px - 0.5));
    vec2  share = place_px - 0.5 - vec2(first);
    vec4  sum   = vec4(0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i)
    {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2  sides  = mix(1.0 - share, share, vec2(corner));
        vec4  stored = imageLoad(previous_reflection_image, clamp(first + corner, ivec2(0), size_px - 1));
        float weight = stored.a < 0.0 ? 0.0 : sides.x * sides.y;
        sum += weight * stored;
        total += weight;
    }
    return total > 0.0 ? vec4(sum.rgb / total, share_of(sum.a, total)) : vec4(-1);
}

// One of HISTORY_ACCUMULATED … HISTORY_OTHER_HIT; only the first comes with a history.
int find_history(ivec2 pixel, out History found)
{
    vec4 now    = reprojected(pixel);
    vec2 centre = vec2(pixel) + 0.5, place_px = centre + now.xy;
    if (!all(lessThan(abs(now.xy), vec2(1e9)))) return HISTORY_UNSEEN;
    if (!in_image(place_px)) return HISTORY_OFF_IMAGE;
    uint object = imageLoad(object_image, pixel).x;
    vec2 px     = place_px - jitter_px;
    if (reject_depth > 0.0 && !shows_surface(pixel, object, px)) return HISTORY_OTHER_DEPTH;
    vec3 normal = turned_pvs(normalize(imageLoad(normal_image, pixel).xyz), object), stored_normal = previous_normal_pvs(px);
    if (reject_normal > -1.0 && !(dot(normal, stored_normal) >= reject_normal * length(stored_normal))) return HISTORY_OTHER_NORMAL;
    vec4 facts = imageLoad(previous_facts_image, ivec2(place_px));
    // What was met there may have moved on, and uncovered the environment.
    if (now.w == hit_nothing && facts.z != hit_nothing && stands_still == 0) return HISTORY_OTHER_HIT;
    bool known = facts.z != hit_unknown && now.w != hit_unknown;
    if (reject_hit && known && facts.z != now.w) return HISTORY_OTHER_HIT;
    found.reflection = previous_reflection(place_px);
    if (found.reflection.a < 0.0) return HISTORY_OTHER_DEPTH;
    found.frames = max(facts.x, 1.0);
    found.share  = 1.0;
    if (hit_distance_tolerance > 0.0 && known)
    {
        bool hit_then = facts.z >= 0.0, hits_now = now.w >= 0.0;
        if (hit_then && hits_now) found.share = exp(-abs(facts.y - now.z) / (hit_distance_tolerance * max(now.z, 1e-6)));
        if (hit_then != hits_now) found.share = 0.0;
    }
    return HISTORY_ACCUMULATED;
}
