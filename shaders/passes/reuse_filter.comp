// What rough pixels reflect, averaged over neighbours of the same surface and roughness: the noise that is left after passes/ray_reuse.comp.
// DENSE is the first of two: over the pixels next to each other, then in steps. The kernel is half as wide as the disk from which that
// takes rays, and no wider than the lobe is where it meets something: what stands on a floor keeps its foot. Mirrors stay as they are, to the
// last bit.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "rays/lobe_threshold.glsl"
#include "pass/parameters"
#include "passes/blocks.glsl"
#include "rays/tiles.glsl"
#include "passes/reflector.glsl"
#include "passes/mean_reflection.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D reflection_image;
layout(set = 0, binding = 5, rgba16f) uniform readonly image2D filtered_image;
layout(set = 0, binding = 6, r32ui) uniform readonly uimage2D block_pixel_image;
layout(set = 0, binding = 8, rgba32f) uniform readonly image2D ray_end_image; // what rays met, in view space

const float roughness_tolerance = 0.05;

#include "passes/lobe_spread.glsl"

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    float roughness = imageLoad(normal_image, pixel).w;
    vec4  value     = imageLoad(filtered_image, pixel);
    imageStore(reflection_image, pixel, value);
    if (value.a < 0.0 || !(roughness >= mirror_roughness)) return;

    Reflector own        = reflector_at(pixel);
    float     spacing_px = 0.25 * reuse_radius * roughness * float(size_px.y);
    vec4      sum        = vec4(0);
    float     total      = 0.0;
#ifdef DENSE
    spacing_px = min(spacing_px, 1.0);
#endif
    float pixel_m = pixel_width_m(own, pixel), own_spread = spread_px(own, pixel, pixel_m);
    for (int i = 0; i < 25; ++i)
    {
        ivec2 step  = ivec2(i % 5, i / 5) - 2;
        ivec2 place = pixel + ivec2(round(vec2(step) * spacing_px));
        if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size_px))) continue;
        float away_px = distance(vec2(place), vec2(pixel));
        if (away_px > spread_reach * own_spread) continue;
        vec4 other = imageLoad(filtered_image, place);
        if (other.a < 0.0) continue;
        float off    = abs(imageLoad(normal_image, place).w - roughness);
        float spread = min(own_spread, spread_px(own, place, pixel_m));
        float weight = exp(-0.5 * float(step.x * step.x + step.y * step.y) - off / roughness_tolerance) *
                       spread_weight(away_px / spread) * same_surface(own, place);
        sum += weight * vec4(other.rgb * other.a, other.a);
        total += weight;
    }
    if (total > 0.0 && sum.a > 0.0) imageStore(reflection_image, pixel, mean_reflection(sum, total));
}
