// What the next frame is to know of this one: depth, plane and normal of each pixel. KEEP_REFLECTION: and its reflection, where no history was
// accumulated; KEEP_PICTURE: and its picture likewise.
#include "api/view.glsl"
#include "rays/reflecting.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 42, r32ui) uniform readonly uimage2D gradient_image;
layout(set = 0, binding = 43, r32f) uniform writeonly image2D previous_depth_image;
layout(set = 0, binding = 44, r32ui) uniform writeonly uimage2D previous_gradient_image;
layout(set = 0, binding = 45, rgba32f) uniform writeonly image2D previous_normal_image;
#ifdef KEEP_REFLECTION
layout(set = 0, binding = 46, rgba16f) uniform readonly image2D reflection_image;
layout(set = 0, binding = 47, rgba32f) uniform writeonly image2D previous_reflection_image;
layout(set = 0, binding = 48, rgba32f) uniform writeonly image2D previous_facts_image;
#endif
#ifdef KEEP_PICTURE
layout(set = 0, binding = 49, rgba16f) uniform readonly image2D shaded_image;
layout(set = 0, binding = 50, rgba32f) uniform writeonly image2D previous_picture_image;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    imageStore(previous_depth_image, pixel, vec4(load_depth(pixel)));
    imageStore(previous_gradient_image, pixel, imageLoad(gradient_image, pixel));
    imageStore(previous_normal_image, pixel, imageLoad(normal_image, pixel));
#ifdef KEEP_REFLECTION
    vec4 reflection = imageLoad(reflection_image, pixel);
    imageStore(previous_reflection_image, pixel, vec4(reflection.rgb * max(reflection.a, 0.0), reflection.a));
    imageStore(previous_facts_image, pixel, vec4(1, 0, -1, 0)); // of no known length and object
#endif
#ifdef KEEP_PICTURE
    imageStore(previous_picture_image, pixel, vec4(imageLoad(shaded_image, pixel).rgb, 1));
#endif
}
