// Depth and planes as tracers read them. Pixels without a surface: their depth becomes BACKGROUND_DEPTH (so does unusable depth: NaN, infinite, negative, nearer than the near
// plane), and their radiance what arrives from infinitely far away along their view ray.
#include "api/view.glsl"
#define DEPTH_BINDING 3
#define PLANES_BINDING 6
#include "layout/store_depth.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1) uniform sampler2D depth_buffer;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D environment_map;
layout(set = 0, binding = 5, r32ui) uniform readonly uimage2D gradient_image;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D radiance_image;
layout(push_constant) uniform Push { mat4 view_to_world; };
#include "gbuffer/environment.glsl"

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    float depth = texelFetch(depth_buffer, pixel, 0).x;
    bool usable = depth > 0.0 && depth <= 1.0;
    store_depth(pixel, usable ? depth : BACKGROUND_DEPTH, usable ? imageLoad(gradient_image, pixel).x : 0);
    if (usable) return;
    vec3 ray_vs = vec3(orthographic != 0 ? vec2(0) : px_to_slope(vec2(pixel) + 0.5), -1.0);
    imageStore(radiance_image, pixel, vec4(environment_radiance(direction_to_uv(mat3(view_to_world) * ray_vs)), 1));
}
