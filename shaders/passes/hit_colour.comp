// The colour that a ray brings back, and how much it weighs: rgb and weight of a pixel's reflection, the mean over the pixel's rays.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/ray_colour.glsl"
#include "passes/given_light.glsl"
#include "passes/mean_reflection.glsl"
#ifdef LOBE_RAYS
#include "passes/lobe_rays.glsl"
#endif

layout(local_size_x = RAYS_PER_GROUP) in;

layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D reflection_image;
layout(set = 0, binding = 15, r32ui) uniform writeonly uimage2D block_pixel_image;

// Colour and weight.
vec4 reflection_of(uint index, PackedHit hit)
{
    GivenLight given = given_light(index);
    if (meets_given(given)) return vec4(given.light * attenuation_at(given.distance_m), 1);
    Found found = found_by(packed_ray(index), hit);
    return vec4(found.light * found.attenuation, found.weight);
}

#if defined(RAYS_OF_PIXELS) && RAYS_OF_PIXELS == 1
// No loop: SwiftShader takes minutes to compile one that makes rays.
#define ONE_RAY
#else
// The mean of the pictures that the rays would make one by one, if more than half of them hit.
// J. Somerville Roberts, "Screen Space Reflections": noise is where few of them do.
vec4 mean_of_rays(uint first)
{
    vec4 sum  = vec4(0);
    int  hits = 0, ray = 0;
    do
    {
        PackedHit hit = packed_hit(first + ray);
        if (shows_surface(hit) || meets_given(given_light(first + ray)))
        {
            vec4 reflection = reflection_of(first + ray, hit);
            sum += vec4(reflection.rgb * reflection.a, reflection.a);
            ++hits;
        }
    } while (++ray < rays_per_pixel);
    return 2 * hits > rays_per_pixel ? mean_reflection(sum, float(rays_per_pixel)) : vec4(0);
}
#endif

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    uint first = index * rays_per_pixel;
    if (first >= ray_count) return;
    ivec2 pixel = unpack_pixel(ray_pixel(first));
    if (!skip_unneeded_passes && !reflects(pixel)) return; // a planned frame has rays of reflecting pixels alone
#if defined(LOBE_RAYS) && defined(ONE_RAY)
    lobe_ray_light(first, pixel, 0);
#elif defined(LOBE_RAYS)
    vec4 mean = vec4(0);
    int  ray  = 0;
    do
    {
        vec4 light = lobe_ray_light(first + ray, pixel, ray);
        mean += vec4(light.rgb * light.a, light.a);
    } while (++ray < rays_per_pixel);
    if (rays_per_pixel > 1) imageStore(reflection_image, pixel, mean_reflection(mean, float(rays_per_pixel)));
#elif defined(ONE_RAY)
    imageStore(reflection_image, pixel, reflection_of(first, packed_hit(first)));
#else
    imageStore(reflection_image, pixel, rays_per_pixel > 1 ? mean_of_rays(first) : reflection_of(first, packed_hit(first)));
#endif
    if (block_px > 1) imageStore(block_pixel_image, pixel / block_px, uvec4(pack_pixel(pixel, 0)));
}
