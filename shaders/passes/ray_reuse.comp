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
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D reused_image;
layout(set = 0, binding = 6, r32ui) uniform readonly uimage2D block_pixel_image;
// Of each ray, ray after ray, an image high: its colour and weight; what it met, in view space, and its density.
layout(set = 0, binding = 7, rgba16f) uniform readonly image2D ray_light_image;
layout(set = 0, binding = 8, rgba32f) uniform readonly image2D ray_end_image;
layout(set = 0, binding = 11, rgba32ui) uniform readonly uimage2D gathered_image; // passes/reuse_gather.comp

const float least_total   = 1e-6; // below it the pixel's own rays stand: next to nothing is left of the digits of a sum
const float least_cosine  = 1e-3; // below it a ray has met its own plane, by rounding
const float largest_ratio = 8.0; // a ray that its own pixel hardly ever draws must not decide

#include "passes/reflector.glsl"
#include "passes/mean_reflection.glsl"
#include "passes/reused_pixel.glsl"

vec4 ray_end(ivec2 pixel, int ray) { return imageLoad(ray_end_image, pixel + ivec2(0, ray * size_px.y)); }

// The pixel that was traced in place of this one; negative: none.
ivec2 traced_pixel(ivec2 pixel)
{
    if (block_px == 1) return pixel;
    uint found = imageLoad(block_pixel_image, pixel / block_px).x;
    return found == NO_PIXEL ? ivec2(-1) : unpack_pixel(found);
}

// How far the lobe of a rough pixel spreads the nearest thing that its rays met: the standard deviation in pixels.
// 1.3 alpha: where the lobe has fallen to a half, for GGX. Pixels farther apart do not see the same things: what one
// sees past a leg, the other may see the leg before.
float spread_px(Reflector own, ivec2 pixel)
{
    const float least = 1e-3; // not a quotient of nothing
    ivec2 traced = traced_pixel(pixel);
    if (traced.x < 0) return least;
    vec3  beside_vs = px_to_vs(vec3(vec2(pixel) + vec2(1.5, 0.5), load_depth(pixel)));
    float nearest_m = 1e30, pixel_m = distance(beside_vs, own.position_vs);
    for (int ray = 0; ray < rays_per_pixel; ++ray)
    {
        vec4 end = ray_end(traced, ray);
        if (end.w > 0.0) nearest_m = min(nearest_m, distance(end.xyz, own.position_vs));
    }
    return max(reuse_spread * 1.3 * own.alpha * nearest_m / pixel_m, least);
}

// lobe_value() toward what lies at `offset`, over the density with which the ray was drawn. 0 toward the plane of the
// pixel itself, and behind it.
float lobe_ratio(Lobe lobe, vec3 offset, float density)
{
    vec3  to_light = offset * inversesqrt(dot(offset, offset));
    float ratio    = lobe_value(lobe, to_light) / density;
    return density > 0.0 && dot(lobe.normal, to_light) > least_cosine ? min(ratio, largest_ratio) : 0.0;
}

// Neighbours lie evenly over a disk, the pixel itself first: H. Vogel 1979, "A better way to construct the sunflower
// head". A ray that does not count has the weight 0: CPU devices run all branches, so there are none.
vec4 reused(ivec2 pixel, Reflector own, float roughness, float spread, vec4 own_light)
{
    const mat2 next_angle = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
    SurfacePlane plane    = surface_plane(own, load_depth(pixel));
    Lobe  lobe       = lobe_of(own.normal_vs, own.to_eye_vs, own.alpha);
    float reach_px   = min(reuse_radius * roughness * float(size_px.y), spread_reach * spread);
    float radius_px  = max(float(block_px) * 1.5, reach_px);
    float turn       = 6.2831853 * float(pcg(uint(pixel.x) + pcg(uint(pixel.y) + offset_seed()))) / 4294967296.0;
    float spacing_px = radius_px / sqrt(float(reuse_neighbours)), sharpness = 1.0 / spread;
    vec2  direction  = vec2(cos(turn), sin(turn));
    vec4  sum        = vec4(0);
    vec3  brightest  = vec3(0);
    float total = 0.0, most = 0.0, next = 0.0;
    int   rays = 0, i = 0;
    do
    {
        ivec2 place  = pixel + ivec2(round(spacing_px * sqrt(float(i)) * direction));
        direction    = next_angle * direction;
        ivec2 inside = clamp(place, ivec2(0), size_px - 1), found_px = traced_pixel(inside);
        ivec2 traced = max(found_px, ivec2(0));
        ReusedPixel other = unpack_reused(imageLoad(gathered_image, traced));
        vec2  step_px = vec2(traced - pixel), away = step_px * sharpness;
        float away2   = dot(away, away);
        bool  counts  = place == inside && found_px.x >= 0 && is_reflection(other.reflection);
        counts        = counts && away2 <= spread_reach * spread_reach;
        float alike   = counts ? exp(-0.5 * away2 - off_surface(plane, step_px, other.depth)) : 0.0;
        for (int ray = 0; ray < rays_per_pixel; ++ray)
        {
            vec4 end = ray_end(traced, ray), light = other.reflection;
            if (rays_per_pixel > 1) light = imageLoad(ray_light_image, traced + ivec2(0, ray * size_px.y));
            float ratio  = lobe_ratio(lobe, end.xyz - own.position_vs, end.w);
            bool  found  = counts && is_reflection(light) && ratio > 0.0;
            vec4  own_share = found ? vec4(light.rgb * light.a, light.a) : vec4(0);
            float bright    = dot(own_share.rgb, vec3(0.2126, 0.7152, 0.0722));
            ratio           = found ? ratio * alike : 0.0;
            vec4 share      = ratio * own_share;
            sum += share;
            total += ratio;
            rays += int(found);
            brightest = bright > most ? share.rgb : brightest;
            next      = max(next, min(bright, most));
            most      = max(most, bright);
        }
    } while (++i < reuse_neighbours);
    // One ray that alone met something bright is a speck: it counts for no more than the next brightest.
    if (rays > 1 && most > 0.0) sum.rgb -= brightest * (1.0 - next / most);
    return total > least_total ? mean_reflection(sum, total) : own_light;
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    ReusedPixel stored    = unpack_reused(imageLoad(gathered_image, pixel));
    float       roughness = imageLoad(normal_image, pixel).w;
    Reflector   own       = reflector_at(pixel);
    float       spread    = spread_px(own, pixel);
    stored.roughness      = roughness;
    stored.sharpness      = 1.0 / spread;
    if (is_reflection(stored.reflection) && roughness >= mirror_roughness)
        stored.reflection = reused(pixel, own, roughness, spread, stored.reflection);
    imageStore(reused_image, pixel, pack_reused(stored));
}
