// Turns hits into colour: C = C_frag + (C_reflect - C_frag) * beta
// J. Somerville Roberts, "Screen Space Reflections": beta = metallic^exponent * facing term * edge fade.
// C_reflect is the part of the hit's colour that does not depend on the direction it is seen from.
#include "view.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(constant_id = CONSTANT_METALLIC_EXPONENT) const float metallic_exponent = 3;
layout(constant_id = CONSTANT_FADE_TO_VIEWER) const int fade_to_viewer = 1;
layout(constant_id = CONSTANT_FADE_AT_EDGES) const int fade_at_edges = 1;

layout(set = 0, binding = 1, rgba16f) uniform readonly image2D material_image;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 3, rgba16f) uniform image2D shaded_image; // holds the lit colour when this pass begins
layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) readonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) readonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 8, scalar) readonly buffer RayPixels { uint ray_pixel[]; };
layout(set = 0, binding = 9, scalar) readonly buffer HitPixels { uint hit_pixel[]; };
layout(set = 0, binding = 10, scalar) readonly buffer HitTs { real hit_t[]; };

// Cosine between the ray and the view axis: 1 = away from the viewer, < 0 = toward the viewer.
float away_from_viewer(vec3 origin, vec3 delta)
{
    vec2  from = px_to_slope(origin.xy), to = px_to_slope(origin.xy + delta.xy);
    float from_depth = origin.z, to_depth = origin.z + delta.z;
    vec3  direction  = orthographic != 0 ? vec3(to - from, delta.z * (far_m - near_m))
                                         : vec3(to * from_depth - from * to_depth, to_depth - from_depth);
    return -normalize(direction).z;
}

void main()
{
    uint index = (gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x) * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count || unpack_number(hit_pixel[index]) != TRACE_HIT) return;
    ivec2 pixel  = unpack_pixel(ray_pixel[index]);
    vec3  origin = ray_origin[index], delta = ray_delta[index];
    vec2  hit_uv = (origin.xy + delta.xy * hit_t[index]) / vec2(size_px);

    float beta = metallic_exponent > 0.0 ? pow(imageLoad(material_image, pixel).a, metallic_exponent) : 1.0;
    if (fade_to_viewer != 0) beta *= max(0.0, away_from_viewer(origin, delta));
    if (fade_at_edges != 0) beta *= clamp(1.0 - abs(hit_uv.x - 0.5) - abs(hit_uv.y - 0.5), 0.0, 1.0);

    vec3 own       = imageLoad(shaded_image, pixel).rgb;
    vec3 reflected = imageLoad(radiance_image, unpack_pixel(hit_pixel[index])).rgb;
    imageStore(shaded_image, pixel, vec4(own + (reflected - own) * beta, 1));
}
