// The depth that tracers read: background and unusable values (NaN, infinite, negative, nearer than the near plane) become BACKGROUND_DEPTH.
#include "shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth_buffer;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D depth_image;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_image)))) return;
    float depth = texelFetch(depth_buffer, pixel, 0).x;
    bool usable = depth > 0.0 && depth <= 1.0;
    imageStore(depth_image, pixel, vec4(usable ? depth : BACKGROUND_DEPTH));
}
