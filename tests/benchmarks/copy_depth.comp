// One copy of the depth image: the yardstick for passes that read all of it.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform readonly image2D depth_image;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D depth_copy;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_copy)))) return;
    imageStore(depth_copy, pixel, imageLoad(depth_image, pixel));
}
