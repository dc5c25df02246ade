// What rough pixels reflect, averaged over neighbours of the same surface and roughness: against the noise that is left
// after passes/ray_reuse.comp. DENSE is the first of two: over the pixels next to each other, then in steps. The kernel
// is half as wide as the disk from which that takes rays, and no wider than the lobe is where either pixel's rays met
// something: what stands on a floor keeps its foot. Mirrors stay as they are, to the last bit.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "rays/lobe_threshold.glsl"
#include "pass/parameters"
#include "rays/tiles.glsl"
#include "passes/reflector.glsl"
#include "passes/mean_reflection.glsl"
#include "passes/reused_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 5, rgba32ui) uniform readonly uimage2D source_image;
#ifdef DENSE
layout(set = 0, binding = 4, rgba32ui) uniform writeonly uimage2D target_image;
#else
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D reflection_image;
#endif

const float roughness_tolerance = 0.05;

// The places at most two steps to the sides away: nine on one lattice, four between them.
vec2 tap_of(int i)
{
    ivec2 turned = i < 9 ? 2 * ivec2(i % 3, i / 3) - 2 : 2 * ivec2(i & 1, i >> 1 & 1) - 1;
    return vec2(turned.x + turned.y, turned.x - turned.y) * 0.5;
}

// A Gaussian with a variance of two squared steps over 13 places: as wide, and as steady, as one of a single step over
// 5 x 5.
vec4 filtered(ivec2 pixel, ReusedPixel stored, float roughness)
{
    SurfacePlane plane      = surface_plane(reflector_at(pixel), stored.depth);
    float        spacing_px = 0.25 * reuse_radius * roughness * float(size_px.y);
#ifdef DENSE
    spacing_px = min(spacing_px, 1.0);
#endif
    vec4  sum   = vec4(0);
    float total = 0.0;
    int   i     = 0;
    do
    {
        vec2  tap     = tap_of(i);
        vec2  step_px = round(tap * spacing_px);
        ivec2 place   = pixel + ivec2(step_px);
        bool  inside  = all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, size_px));
        ReusedPixel other = unpack_reused(imageLoad(source_image, clamp(place, ivec2(0), size_px - 1)));
        vec2  away    = step_px * larger(stored.sharpness, other.sharpness);
        float away2   = dot(away, away), rougher = abs(other.roughness - stored.roughness) / roughness_tolerance;
        float off     = 0.25 * dot(tap, tap) + 0.5 * away2 + rougher + off_surface(plane, step_px, other.depth);
        bool  counts  = inside && is_reflection(other.reflection) && away2 <= spread_reach * spread_reach;
        float weight = counts ? exp(-off) : 0.0;
        vec4  light  = counts ? other.reflection : vec4(0);
        sum += weight * vec4(light.rgb * light.a, light.a);
        total += weight;
    } while (++i < 13);
    return total > 0.0 && sum.a > 0.0 ? mean_reflection(sum, total) : stored.reflection;
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    uvec4       texel     = imageLoad(source_image, pixel);
    ReusedPixel stored    = unpack_reused(texel);
    float       roughness = imageLoad(normal_image, pixel).w;
    vec4        light     = stored.reflection;
    if (is_reflection(light) && roughness >= mirror_roughness) light = nearest_half(filtered(pixel, stored, roughness));
#ifdef DENSE
    imageStore(target_image, pixel, uvec4(packHalf2x16(light.rg), packHalf2x16(light.ba), texel.zw));
#else
    imageStore(reflection_image, pixel, light);
#endif
}
