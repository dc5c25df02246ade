// The reflection of a rough pixel from its own ray and those of its neighbours: each counts by the pixel's own BRDF toward what the ray
// found, over the density with which the neighbour drew it, and the sum is divided by the sum of these ratios.
// T. Stachowiak 2015, "Stochastic Screen-Space Reflections", Advances in Real-Time Rendering, SIGGRAPH.
#include "api/view.glsl"
#include "api/hash.glsl"
#include "rays/reflecting.glsl"
#include "rays/lobe.glsl"
#include "pass/parameters"
#include "passes/blocks.glsl"
#include "rays/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D reflection_image;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D filtered_image;
layout(set = 0, binding = 6, r32ui) uniform readonly uimage2D block_pixel_image;
layout(set = 0, binding = 7, rgba16f) uniform readonly image2D ray_light_image; // of each ray: colour, weight; ray after ray, an image high
layout(set = 0, binding = 8, rgba32f) uniform readonly image2D ray_end_image;   // what it met, in view space; the density of its direction

const float least_total   = 1e-6; // below it the pixel's own rays stand: next to nothing is left of the digits of a sum
const float least_cosine  = 1e-3; // below it a ray has met its own plane, by rounding
const float largest_ratio = 8.0; // a ray that its own pixel hardly ever draws must not decide

#include "passes/reflector.glsl"
#include "passes/mean_reflection.glsl"
#include "passes/lobe_spread.glsl"

// Evenly over a disk, the pixel itself first: H. Vogel 1979, "A better way to construct the sunflower head".
ivec2 neighbour(ivec2 pixel, int i, float radius_px, float turn)
{
    float distance_px = radius_px * sqrt(float(i) / float(reuse_neighbours)), angle = turn + 2.3999632 * float(i);
    return pixel + ivec2(round(distance_px * vec2(cos(angle), sin(angle))));
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px)) || !reflects(pixel)) return;
    float roughness = imageLoad(normal_image, pixel).w;
    vec4  own_light = imageLoad(reflection_image, pixel);
    imageStore(filtered_image, pixel, own_light);
    if (!(roughness >= mirror_roughness)) return;

    Reflector own    = reflector_at(pixel);
    float spread     = spread_px(own, pixel, pixel_width_m(own, pixel));
    float radius_px  = max(float(block_px) * 1.5, min(reuse_radius * roughness * float(size_px.y), spread_reach * spread));
    float turn       = 6.2831853 * float(pcg(uint(pixel.x) + pcg(uint(pixel.y) + offset_seed()))) / 4294967296.0;
    vec4  sum        = vec4(0);
    vec3  brightest  = vec3(0);
    float total = 0.0, most = 0.0, next = 0.0;
    int   rays  = 0;
    for (int i = 0; i < reuse_neighbours; ++i)
    {
        ivec2 place = neighbour(pixel, i, radius_px, turn);
        if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size_px))) continue;
        place = traced_pixel(place);
        if (place.x < 0) continue;
        float near = spread_weight(distance(vec2(place), vec2(pixel)) / spread);
        if (near == 0.0 || !reflects(place)) continue;
        float alike = near * same_surface(own, place);
        for (int ray = 0; ray < rays_per_pixel; ++ray)
        {
            ivec2 texel = place + ivec2(0, ray * size_px.y);
            vec4  light = imageLoad(ray_light_image, texel), end = imageLoad(ray_end_image, texel);
            vec3  to_light = normalize(end.xyz - own.position_vs);
            if (light.a < 0.0 || !(end.w > 0.0) || !(dot(own.normal_vs, to_light) > least_cosine)) continue;
            float ratio = alike * min(lobe_value(own.normal_vs, own.to_eye_vs, to_light, own.alpha) / end.w, largest_ratio);
            sum += ratio * vec4(light.rgb * light.a, light.a);
            total += ratio;
            ++rays;
            float bright = light.a * dot(light.rgb, vec3(0.2126, 0.7152, 0.0722));
            if (bright > most) brightest = ratio * light.a * light.rgb;
            next = max(next, min(bright, most));
            most = max(most, bright);
        }
    }
    // One ray that alone met something bright is a speck: it counts for no more than the next brightest.
    if (rays > 1 && most > 0.0) sum.rgb -= brightest * (1.0 - next / most);
    if (total > least_total) imageStore(filtered_image, pixel, mean_reflection(sum, total));
}
