// The picture: C = C_own + (C_reflected - C_own) * beta.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/beta.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 5, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 6, rgba16f) uniform readonly image2D reflection_image; // a < 0: nothing
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D shaded_image;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shaded_image)))) return;
    vec3 colour     = imageLoad(radiance_image, pixel).rgb + imageLoad(highlight_image, pixel).rgb;
    vec4 reflection = imageLoad(reflection_image, pixel);
    if (reflection.a > 0.0) colour += (reflection.rgb - colour) * beta_of(pixel, to_camera_vs(pixel), reflection.a);
    imageStore(shaded_image, pixel, vec4(colour, 1));
}
