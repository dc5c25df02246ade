// What the rays of a rough pixel's lobe bring back, kept ray by ray for passes/ray_reuse.comp. After passes/ray_colour.glsl and given_light.glsl.
#include "api/hash.glsl"
#include "rays/lobe.glsl"
#include "passes/reflector.glsl"
#ifdef ENVIRONMENT
#include "passes/environment_lobe.glsl"
#endif

layout(set = 0, binding = 65, rgba16f) uniform writeonly image2D ray_light_image;
layout(set = 0, binding = 66, rgba32f) uniform writeonly image2D ray_end_image;

const float ray_far_m = 1e6; // where a ray ends that found nothing

// Colour and weight; with an environment it has its share in the colour, and the weight is 1.
vec4 lobe_ray_light(uint index, ivec2 pixel, int number)
{
    PackedRay ray       = packed_ray(index);
    PackedHit hit       = packed_hit(index);
    Found     found     = found_by(ray, hit);
    vec3      direction = ray_direction(ray), origin_vs = px_to_vs(ray.origin);
    Reflector own       = reflector_at(pixel);
    float     roughness = imageLoad(normal_image, pixel).w;

    vec4 light = vec4(found.light * found.attenuation, found.weight);
    GivenLight given = given_light(index);
    if (meets_given(given)) light = vec4(given.light * attenuation_at(given.distance_m), 1);
#ifdef ENVIRONMENT
    // Blurred by half the lobe's width: a ray stands for its share of the lobe.
    if (light.a < 1.0) light.rgb = mix(environment_lobe(direction, direction, 0.7 * roughness), light.rgb, light.a);
    light.a = 1.0;
#endif
    vec3  end_vs  = origin_vs + direction * (meets_given(given) ? given.distance_m : ray_far_m);
    if (shows_surface(hit)) end_vs = px_to_vs(ray.origin + ray.delta * hit.t);
    float density = roughness >= mirror_roughness ? lobe_density(own.normal_vs, own.to_eye_vs, direction, own.alpha) : 0.0;
    imageStore(ray_light_image, pixel + ivec2(0, number * size_px.y), light);
    imageStore(ray_end_image, pixel + ivec2(0, number * size_px.y), vec4(end_vs, density));
    return light;
}
