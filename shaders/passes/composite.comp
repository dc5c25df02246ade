// The picture: each surface's own light with its reflection.
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
    vec4 reflection = imageLoad(reflection_image, pixel);
    vec3 own = imageLoad(radiance_image, pixel).rgb, highlight = imageLoad(highlight_image, pixel).rgb, colour = own + highlight;
    if (reflection.a > 0.0) colour = with_reflection(pixel, to_camera_vs(pixel), own, highlight, reflection.rgb, reflection.a);
    imageStore(shaded_image, pixel, vec4(colour, 1));
}
