// The colour that a ray brings back, and how much it weighs: rgb and weight of a pixel's reflection, the mean over the pixel's rays.
#include "view.glsl"
#include "reflecting.glsl"
#include "effect/parameters"
#include "effects/blocks.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) readonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) readonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 8, scalar) readonly buffer RayPixels { uint ray_pixel[]; };
layout(set = 0, binding = 9, scalar) readonly buffer HitPixels { uint hit_pixel[]; };
layout(set = 0, binding = 10, scalar) readonly buffer HitTs { real hit_t[]; };
layout(set = 0, binding = 11, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 12, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D reflection_image;
layout(set = 0, binding = 14, rgba16f) uniform readonly image2D small_colour_image;
layout(set = 0, binding = 15, r32ui) uniform writeonly uimage2D block_pixel_image;

#ifdef MIRRORED_LIGHT
#define LIGHTS_BINDING 14
#include "lighting.glsl"
layout(set = 0, binding = 17, scalar) uniform Frame // the beginning of gbuffer.frag's
{
    mat4  world_to_view;
    vec3  eye_ws;
    int   frame_orthographic;
    vec3  view_axis_ws;
    int   light_count;
};

// The highlight of a surface as the reflector sees it.
vec3 highlight_along(ivec2 pixel, vec3 position_vs, vec3 direction_vs)
{
    mat3 view_to_world = transpose(mat3(world_to_view));
    vec4 normal        = imageLoad(normal_image, pixel), material = imageLoad(material_image, pixel);
    vec3 position_ws   = view_to_world * (position_vs - world_to_view[3].xyz), irradiance, highlights;
    light_surface(Surface(position_ws, view_to_world * normal.xyz, material.rgb, material.a, normal.w), light_count,
                  view_to_world * -direction_vs, irradiance, highlights);
    return highlights;
}
#endif

// Direction of the ray in view space, from two points of its segment; the end may lie at infinity.
vec3 ray_direction(vec3 origin, vec3 delta)
{
    vec2  from = px_to_slope(origin.xy), to = px_to_slope(origin.xy + delta.xy);
    float from_depth = origin.z, to_depth = origin.z + delta.z;
    vec3  direction  = orthographic != 0 ? vec3(to - from, delta.z * (far_m - near_m))
                                         : vec3(to * from_depth - from * to_depth, to_depth - from_depth);
    return normalize(direction);
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
    return 1.0;
}

// Litheon's proposal: where the depths about the hit jump, the hit is doubtful.
float depth_step_weight(ivec2 pixel)
{
    if (depth_step_fade_m <= 0.0) return 1.0;
    float own_m = depth_to_distance(imageLoad(depth_image, pixel).x), largest_m = 0.0;
    for (int i = 0; i < 4; ++i)
    {
        ivec2 next  = clamp(pixel + ivec2((i & 1) * (i - 2), (1 - (i & 1)) * (i - 1)), ivec2(0), size_px - 1);
        float depth = imageLoad(depth_image, next).x;
        largest_m   = max(largest_m, depth > 0.0 ? abs(depth_to_distance(depth) - own_m) : depth_step_fade_m);
    }
    return 1.0 - clamp(largest_m / depth_step_fade_m, 0.0, 1.0);
}

float weight_of(float away, vec2 uv, ivec2 pixel)
{
    float viewer = viewer_weight(away), edge = edge_weight(uv), depth_step = depth_step_weight(pixel);
    if (fade_combination == fade_combination_minimum) return min(min(viewer, edge), min(depth_step, 1.0 - own_share));
    return viewer * edge * depth_step * (1.0 - own_share);
}

float attenuation_at(float distance_m)
{
    if (attenuation == attenuation_inverse) return min(1.0, 1.0 / distance_m); // A. Biro, Report on Screen-Space Reflections
    if (attenuation == attenuation_inverse_square) return min(1.0, 1.0 / (distance_m * distance_m));
    return 1.0;
}

vec3 colour_at(ivec2 hit, vec2 point_px)
{
    if (block_px > 1 && cross_blur)
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
    vec3 colour = imageLoad(radiance_image, hit).rgb;
    if (hit_light == hit_light_lit) colour += imageLoad(highlight_image, hit).rgb;
    return colour;
}

vec4 reflection_of(uint index)
{
    ivec2 hit    = unpack_pixel(hit_pixel[index]);
    vec3  origin = ray_origin[index], delta = ray_delta[index], point = origin + delta * hit_t[index];
    vec3  direction = ray_direction(origin, delta), origin_vs = px_to_vs(origin);
    vec3  surface_vs = px_to_vs(vec3(vec2(hit) + 0.5, imageLoad(depth_image, hit).x));
    // A. Biro: a surface that is met elsewhere than where the ray goes is the wrong one.
    if (dot(direction, normalize(surface_vs - origin_vs)) < min_direction_cosine) return vec4(0);
    vec3 colour = colour_at(hit, point.xy);
#ifdef MIRRORED_LIGHT
    colour += highlight_along(hit, surface_vs, direction);
#endif
    colour *= attenuation_at(distance(px_to_vs(point), origin_vs));
    return vec4(colour, weight_of(-direction.z, point.xy / vec2(size_px), hit));
}

// The mean of the pictures that the rays would make one by one, if more than half of them hit.
// J. Somerville Roberts, "Screen Space Reflections": noise is where few of them do.
vec4 mean_reflection(uint first)
{
    vec4 sum  = vec4(0);
    int  hits = 0;
    for (int ray = 0; ray < rays_per_pixel; ++ray)
    {
        if (unpack_number(hit_pixel[first + ray]) == TRACE_HIT)
        {
            vec4 reflection = reflection_of(first + ray);
            sum += vec4(reflection.rgb * reflection.a, reflection.a);
            ++hits;
        }
    }
    if (2 * hits <= rays_per_pixel || sum.a <= 0.0) return vec4(0);
    return vec4(sum.rgb / sum.a, sum.a / float(rays_per_pixel));
}

void main()
{
    uint index = (gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x) * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    uint first = index * rays_per_pixel;
    if (first >= ray_count) return;
    ivec2 pixel = unpack_pixel(ray_pixel[first]);
    if (!reflects(pixel)) return;
    vec4 reflection = vec4(0);
    if (rays_per_pixel > 1)
        reflection = mean_reflection(first);
    else if (unpack_number(hit_pixel[first]) == TRACE_HIT)
        reflection = reflection_of(first);
    imageStore(reflection_image, pixel, reflection);
    if (block_px > 1) imageStore(block_pixel_image, pixel / block_px, uvec4(pack_pixel(pixel, 0)));
}
