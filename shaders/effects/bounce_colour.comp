// Mixes what a further bounce found into the reflection that it belongs to: C = C_own + (C_reflected - C_own) * beta at the reflector
// where the bounce began, times what that still weighs.
#include "view.glsl"
#include "reflecting.glsl"
#include "effect/parameters"
#include "effects/ray_colour.glsl"
#include "effects/beta.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) readonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) readonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 8, scalar) readonly buffer RayPixels { uint ray_pixel[]; };
layout(set = 0, binding = 9, scalar) readonly buffer HitPixels { uint hit_pixel[]; };
layout(set = 0, binding = 10, scalar) readonly buffer HitTs { real hit_t[]; };
layout(set = 0, binding = 13, rgba16f) uniform image2D reflection_image;
layout(set = 0, binding = 17, scalar) readonly buffer RaySources { uint ray_source[]; };
layout(set = 0, binding = 18, scalar) buffer RayThroughputs { float ray_throughput[]; };

void main()
{
    uint index = (gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x) * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count) return;
    Found found = found_by(ray_origin[index], ray_delta[index], hit_pixel[index], hit_t[index]);
    ivec2 reflector = unpack_pixel(ray_pixel[index]), target = unpack_pixel(ray_source[index]);
    float beta = beta_of(reflector, found.weight), throughput = ray_throughput[index] * beta;
    ray_throughput[index] = throughput * found.attenuation;
    if (throughput <= 0.0) return;
    vec4 reflection = imageLoad(reflection_image, target);
    reflection.rgb += throughput * (found.light * found.attenuation - light_of(reflector));
    imageStore(reflection_image, target, reflection);
}
