// Mixes what a further bounce found into the reflection that it belongs to: C = C_own + (C_reflected - C_own) * beta at the reflector
// where the bounce began, times what that still weighs.
#include "layout/workgroups.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/ray_colour.glsl"
#include "passes/beta.glsl"

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
    if (found.weight <= 0.0)
    {
        ray_throughput[index] = vec3(0);
        return;
    }
    vec2 centre     = vec2(reflector) + 0.5;
    vec3 surface_vs = px_to_vs(vec3(centre, load_depth(reflector)));
    vec3 arrived_vs = reflect(ray_direction(ray), normalize(imageLoad(normal_image, reflector).xyz));
    vec3 own        = surface_light(reflector, 0, centre) + highlight_along(reflector, 0, surface_vs, arrived_vs);
    vec3 throughput = ray_throughput[index] * beta_of(reflector, -arrived_vs, found.weight);
    ray_throughput[index] = throughput * found.attenuation;
    vec4 reflection = imageLoad(reflection_image, target);
    // Where a cone saw the reflector, its own colour may be more than what there is.
    reflection.rgb = max(reflection.rgb + throughput * (found.light * found.attenuation - own), 0.0);
    imageStore(reflection_image, target, reflection);
}
