// What rays without a hit would have seen: the environment about the mirror direction, blended by the weight of the reflection.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "rays/tiles.glsl"
#include "passes/environment_lobe.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform image2D reflection_image;

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    vec4 reflection = imageLoad(reflection_image, pixel);
    if (reflection.a < 0.0 || reflection.a >= 1.0) return;
    vec3 view_vs   = normalize(orthographic != 0 ? vec3(0, 0, -1) : vec3(px_to_slope(vec2(pixel) + 0.5), -1.0));
    vec4 stored    = imageLoad(normal_image, pixel);
    vec3 normal_vs = normalize(stored.xyz);
    normal_vs      = dot(normal_vs, view_vs) > 0.0 ? -normal_vs : normal_vs;
    vec3 environment = environment_lobe(reflect(view_vs, normal_vs), normal_vs, stored.w);
    imageStore(reflection_image, pixel, vec4(environment + (reflection.rgb - environment) * reflection.a, 1));
}
