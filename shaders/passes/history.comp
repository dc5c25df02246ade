// Accumulates the reflection over the frames: H = own + (H_before - own) * weight, of colours times their weights. H_before may first be clamped to
// what the pixel's neighbourhood holds now (B. Karis 2014, High-Quality Temporal Supersampling; variance: M. Salvi 2016, An Excursion in Temporal
// Supersampling).
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "rays/tiles.glsl"
#include "pass/parameters"
#include "passes/previous_frame.glsl"
#include "passes/history_lookup.glsl"
#include "passes/history_clamping.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D reflection_image;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D filtered_image;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D kept_reflection_image; // for the next frame
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D kept_facts_image;
layout(set = 0, binding = 8, scalar) buffer HistoryCounts { uint history_counts[HISTORY_COUNTS]; };

const float half_rounding = 1.0 / 2048.0; // of the reflection's image

vec4 weighted(vec4 reflection) { return vec4(reflection.rgb * reflection.a, reflection.a); }

vec4 clamped_to_neighbours(ivec2 pixel, vec4 value)
{
    vec4 around[9];
    int  count = 0;
    for (int i = 0; i < 9; ++i)
    {
        vec4 stored = imageLoad(reflection_image, clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), size_px - 1));
        if (stored.a >= 0.0) around[count++] = weighted(stored);
    }
    return clamped_to(around, count, value);
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    vec4 own = imageLoad(reflection_image, pixel);
    imageStore(filtered_image, pixel, own);
    if (own.a < 0.0) return;
    History found;
    int     outcome = find_history(pixel, found);
    vec4    now = reprojected(pixel), result = weighted(own);
    float   frames = 1.0;
    if (outcome == HISTORY_ACCUMULATED && takes_history != 0)
    {
        vec4 before = found.reflection;
        if (history_clamping != history_clamping_off) before = clamped_to_neighbours(pixel, before);
        // A mean of equal halves is not quite equal to them: that is not clamping.
        if (any(greaterThan(abs(before - found.reflection), abs(found.reflection) * half_rounding))) atomicAdd(history_counts[HISTORY_CLAMPED], 1);
        // A plain mean until there are enough frames for the weight.
        float weight = min(found.frames / (found.frames + 1.0), history_weight) * found.share;
        result       = result + (before - result) * weight;
        frames       = found.frames * found.share + 1.0;
        imageStore(filtered_image, pixel, result.a > 0.0 ? vec4(result.rgb / result.a, result.a) : vec4(0));
    }
    atomicAdd(history_counts[outcome], 1);
    imageStore(kept_reflection_image, pixel, result);
    imageStore(kept_facts_image, pixel, vec4(frames, now.zw, 0));
}
