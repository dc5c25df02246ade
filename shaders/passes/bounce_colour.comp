// Mixes what a further bounce found, or the environment where it found nothing, into the reflection that it belongs to: what the reflector
// where the bounce began shows with it, in the place of what it shows without, times what that still weighs.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/ray_colour.glsl"
#include "passes/beta.glsl"
#ifdef ENVIRONMENT
#include "passes/environment_lobe.glsl"
#endif

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 13, rgba16f) uniform image2D reflection_image;
layout(set = 0, binding = 17, scalar) readonly buffer RaySources { uint ray_source[]; };
layout(set = 0, binding = 18, scalar) buffer RayThroughputs { vec3 ray_throughput[]; };

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count) return;
    PackedRay ray = packed_ray(index);
    ivec2 reflector = unpack_pixel(ray.pixel), target = unpack_pixel(ray_source[index]);
    Found found = found_by(ray, packed_hit(index));
    vec3  reflected_vs = ray_direction(ray), normal_vs = normalize(imageLoad(normal_image, reflector).xyz);
    vec3  reflected = found.light * found.attenuation;
    float weight    = found.weight;
#ifdef ENVIRONMENT
    if (weight < 1.0) reflected = mix(environment_lobe(reflected_vs, normal_vs, imageLoad(normal_image, reflector).w), reflected, weight);
    weight = 1.0;
#endif
    vec2 centre     = vec2(reflector) + 0.5;
    vec3 surface_vs = px_to_vs(vec3(centre, load_depth(reflector)));
    vec3 arrived_vs = reflect(reflected_vs, normal_vs);
    vec3 own        = surface_light(reflector, 0, centre), highlight = highlight_along(reflector, 0, surface_vs, arrived_vs, 0.0);
    vec3 throughput = ray_throughput[index];
    ray_throughput[index] = throughput * reflectance_of(reflector, -arrived_vs) * found.weight * found.attenuation;
    vec4 reflection = imageLoad(reflection_image, target);
    vec3 gained     = with_reflection(reflector, -arrived_vs, own, highlight, reflected, weight) - own - highlight;
    // Where a cone saw the reflector, its own colour may be more than what there is.
    reflection.rgb = max(reflection.rgb + throughput * gained, 0.0);
    imageStore(reflection_image, target, reflection);
}
