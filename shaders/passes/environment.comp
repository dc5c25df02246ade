// What rays without a hit would have seen: the environment in the mirror direction, blended by the weight of the reflection.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "rays/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform image2D reflection_image;
layout(set = 0, binding = 5) uniform sampler2D environment_map;
layout(set = 0, binding = 6, scalar) uniform Frame { mat4 world_to_view; }; // the beginning of gbuffer.frag's
#include "gbuffer/environment.glsl"

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    vec4 reflection = imageLoad(reflection_image, pixel);
    if (reflection.a < 0.0 || reflection.a >= 1.0) return;
    vec3 view_vs = orthographic != 0 ? vec3(0, 0, -1) : vec3(px_to_slope(vec2(pixel) + 0.5), -1.0);
    vec3 mirror_vs = reflect(normalize(view_vs), normalize(imageLoad(normal_image, pixel).xyz));
    vec3 environment = environment_radiance(transpose(mat3(world_to_view)) * mirror_vs);
    imageStore(reflection_image, pixel, vec4(environment + (reflection.rgb - environment) * reflection.a, 1));
}
