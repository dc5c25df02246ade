// What a ray brings back of the surface that it hit, and how much that weighs. After ray_list.glsl, hit_list.glsl, view.glsl,
// reflecting.glsl and pass/parameters.
#include "passes/blocks.glsl"
#include "passes/shown_hits.glsl"

layout(set = 0, binding = 11, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 12, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 14, rgba16f) uniform readonly image2D small_colour_image;
#define DECLARE_COLOURS(number, place)                                                                     \
    LOADED_FLOATS(place, layer_##number##_depth_words)                                                     \
    layout(set = 0, binding = place + 1, rgba32f) uniform readonly image2D layer_##number##_normal_image;   \
    layout(set = 0, binding = place + 2, rgba16f) uniform readonly image2D layer_##number##_material_image; \
    layout(set = 0, binding = place + 3, rgba16f) uniform readonly image2D layer_##number##_radiance_image; \
    layout(set = 0, binding = place + 4, rgba16f) uniform readonly image2D layer_##number##_highlight_image; \
    layout(set = 0, binding = place + 5, r32f) uniform readonly image2D layer_##number##_dielectric_image;
#define OF_LAYER(load, number, name, place, layer, otherwise) ((layer) == number ? load(layer_##number##_##name, place) : otherwise)
#if LAYERS > 3
DECLARE_COLOURS(3, 82)
#define LOAD_FROM_3(load, name, place, layer) OF_LAYER(load, 3, name, place, layer, load(name, place))
#else
#define LOAD_FROM_3(load, name, place, layer) load(name, place)
#endif
#if LAYERS > 2
DECLARE_COLOURS(2, 76)
#define LOAD_FROM_2(load, name, place, layer) OF_LAYER(load, 2, name, place, layer, LOAD_FROM_3(load, name, place, layer))
#else
#define LOAD_FROM_2(load, name, place, layer) LOAD_FROM_3(load, name, place, layer)
#endif
#if LAYERS > 1
DECLARE_COLOURS(1, 70)
#define LOAD_FROM_1(load, name, place, layer) OF_LAYER(load, 1, name, place, layer, LOAD_FROM_2(load, name, place, layer))
#else
#define LOAD_FROM_1(load, name, place, layer) LOAD_FROM_2(load, name, place, layer)
#endif
#define LOAD_LAYER(name, place, layer) LOAD_FROM_1(imageLoad, name, place, layer)

float layer_depth(ivec2 pixel, int layer)
{
    return LOAD_FROM_1(LOAD_TEXEL, depth_words, depth_word(pixel), layer).x;
}

struct Found
{
    vec3  light; // of the surface
    float attenuation;
    float weight;
};

#ifdef CONE
#include "passes/cone.glsl"
#endif
// The highlight of a surface as the reflector sees it, if that is asked for; at least as rough as the reflector, which blurs it.
#ifdef MIRRORED_LIGHT
#define LIGHTS_BINDING 31
#include "gbuffer/lighting.glsl"
#include "passes/scene_frame.glsl"

vec3 highlight_along(ivec2 pixel, int layer, vec3 position_vs, vec3 direction_vs, float roughness)
{
    mat3 view_to_world = transpose(mat3(world_to_view));
    vec4 normal        = LOAD_LAYER(normal_image, pixel, layer), material = LOAD_LAYER(material_image, pixel, layer);
    float dielectric   = LOAD_LAYER(dielectric_image, pixel, layer).x;
    vec3 position_ws   = view_to_world * (position_vs - world_to_view[3].xyz), irradiance, highlights;
    light_surface(Surface(position_ws, view_to_world * normal.xyz, material.rgb, material.a, max(normal.w, roughness), dielectric),
                  view_to_world * -direction_vs, irradiance, highlights);
    return highlights;
}
#else
vec3 highlight_along(ivec2 pixel, int layer, vec3 position_vs, vec3 direction_vs, float roughness)
{
    return vec3(0);
}
#endif

vec3 blurred_light(vec2 point_px)
{
    ivec2 size  = (size_px - 1) / block_px + 1;
    vec2  place = point_px / float(block_px) - 0.5;
    ivec2 from  = ivec2(floor(place)), to = min(from + 1, size - 1);
    vec2  share = place - vec2(from);
    from        = max(from, ivec2(0));
    vec3 above  = mix(imageLoad(small_colour_image, from).rgb, imageLoad(small_colour_image, ivec2(to.x, from.y)).rgb, share.x);
    vec3 below  = mix(imageLoad(small_colour_image, ivec2(from.x, to.y)).rgb, imageLoad(small_colour_image, to).rgb, share.x);
    return mix(above, below, share.y);
}

// The part of a surface's light that rays bring back from wherever they come: of the pixel, or about point_px where rays have a lower
// resolution.
vec3 surface_light(ivec2 pixel, int layer, vec2 point_px)
{
    if (block_px > 1 && downsample_cross_blur) return blurred_light(point_px);
    vec3 light = LOAD_LAYER(radiance_image, pixel, layer).rgb;
    if (hit_shading == hit_shading_lit) light += LOAD_LAYER(highlight_image, pixel, layer).rgb;
    return light;
}

vec3 ray_direction(PackedRay ray)
{
    return normalize(px_to_direction_vs(ray.origin, ray.origin + ray.delta));
}

// Reflections toward the viewer show the wrong side of things. 1 = away from the viewer.
float viewer_weight(float away)
{
    if (viewer_fade == viewer_fade_linear) return max(0.0, away); // J. Somerville Roberts, Screen Space Reflections
    if (viewer_fade == viewer_fade_cut) return away > 0.0 ? 1.0 : 0.0;
    // Litheon 2012, Real-Time Local Reflections
    if (viewer_fade == viewer_fade_smooth) return clamp((away - viewer_fade_start) / (1.0 - viewer_fade_start), 0.0, 1.0);
    return 1.0;
}

float edge_weight(vec2 uv)
{
    vec2  offset = uv - 0.5;
    float radial = clamp(length(offset) * 2.0, 0.0, 1.0);
    if (edge_fade == edge_fade_manhattan) return clamp(1.0 - abs(offset.x) - abs(offset.y), 0.0, 1.0); // J. Somerville Roberts
    if (edge_fade == edge_fade_linear) return 1.0 - radial;
    if (edge_fade == edge_fade_squared) return 1.0 - radial * radial; // Litheon 2012
    if (edge_fade == edge_fade_border)
    {
        vec2 inside_px = (0.5 - abs(offset)) * vec2(size_px);
        return smoothstep(0.0, edge_fade_width * float(size_px.y), min(inside_px.x, inside_px.y));
    }
    return 1.0;
}

// Litheon's proposal: where the depths about the hit jump, the hit is doubtful.
float depth_step_weight(ivec2 pixel, int layer)
{
    if (depth_step_fade_m <= 0.0) return 1.0;
    float own_m = depth_to_distance(layer_depth(pixel, layer)), largest_m = 0.0;
    for (int i = 0; i < 4; ++i)
    {
        ivec2 next  = clamp(pixel + ivec2((i & 1) * (i - 2), (1 - (i & 1)) * (i - 1)), ivec2(0), size_px - 1);
        float depth = layer_depth(next, layer);
        largest_m   = max(largest_m, depth > 0.0 ? abs(depth_to_distance(depth) - own_m) : depth_step_fade_m);
    }
    return 1.0 - clamp(largest_m / depth_step_fade_m, 0.0, 1.0);
}

float weight_of(float away, vec2 uv, float depth_step)
{
    float viewer = viewer_weight(away), edge = edge_weight(uv);
    if (fade_operator == fade_operator_minimum) return min(min(viewer, edge), min(depth_step, 1.0 - base_colour_min_weight));
    return viewer * edge * depth_step * (1.0 - base_colour_min_weight);
}

float attenuation_at(float distance_m)
{
    if (attenuation == attenuation_inverse) return min(1.0, 1.0 / distance_m); // A. Biro, Report on Screen-Space Reflections
    if (attenuation == attenuation_inverse_square) return min(1.0, 1.0 / (distance_m * distance_m));
    return 1.0;
}

// What the ray found; nothing if it missed.
Found found_by(PackedRay ray, PackedHit found)
{
    if (!shows_surface(found)) return Found(vec3(0), 0.0, 0.0);
    ivec2 hit       = unpack_pixel(found.pixel);
    int   layer     = unpack_layer(found.pixel);
    vec3  point     = ray.origin + ray.delta * found.t;
    vec3  direction = ray_direction(ray), origin_vs = px_to_vs(ray.origin);
    vec3  surface_vs = px_to_vs(vec3(vec2(hit) + 0.5, layer_depth(hit, layer)));
    // A. Biro: a surface that is met elsewhere than where the ray goes is the wrong one.
    if (dot(direction, normalize(surface_vs - origin_vs)) < min_direction_cosine) return Found(vec3(0), 0.0, 0.0);
    vec3 light = surface_light(hit, layer, point.xy);
#ifdef CONE
    ivec2 reflector = unpack_pixel(ray.pixel);
    if (layer == 0) light = cone_light(vec2(reflector) + 0.5, point.xy, imageLoad(normal_image, reflector).w, light);
#endif
    light += highlight_along(hit, layer, surface_vs, direction, imageLoad(normal_image, unpack_pixel(ray.pixel)).w);
    return Found(light, attenuation_at(distance(px_to_vs(point), origin_vs)),
                 weight_of(-direction.z, point.xy / vec2(size_px), depth_step_weight(hit, layer)));
}
