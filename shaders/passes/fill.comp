// One value for every pixel of an image: what it holds where a pass writes nothing.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, FORMAT) uniform writeonly IMAGE filled_image;
layout(push_constant) uniform Push { uvec4 bits; };

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(filled_image)))) return;
    imageStore(filled_image, pixel, VALUE(bits));
}
