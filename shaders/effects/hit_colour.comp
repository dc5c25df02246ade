// The colour that a ray brings back, and how much it weighs: rgb and weight of a pixel's reflection.
#include "view.glsl"
#include "reflecting.glsl"
#include "effect/parameters"
#include "effects/ray_colour.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) readonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) readonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 8, scalar) readonly buffer RayPixels { uint ray_pixel[]; };
layout(set = 0, binding = 9, scalar) readonly buffer HitPixels { uint hit_pixel[]; };
layout(set = 0, binding = 10, scalar) readonly buffer HitTs { real hit_t[]; };
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D reflection_image;

void main()
{
    uint index = (gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x) * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count) return;
    ivec2 pixel = unpack_pixel(ray_pixel[index]);
    if (!reflects(pixel)) return;
    Found found = found_by(ray_origin[index], ray_delta[index], hit_pixel[index], hit_t[index]);
    imageStore(reflection_image, pixel, vec4(found.light * found.attenuation, found.weight));
}
