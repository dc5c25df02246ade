// The picture without reflections: both parts of the lit colour.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D shaded_image;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shaded_image)))) return;
    imageStore(shaded_image, pixel, vec4(imageLoad(radiance_image, pixel).rgb + imageLoad(highlight_image, pixel).rgb, 1));
}
