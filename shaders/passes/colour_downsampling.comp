// The colours that rays find, at the resolution at which they are traced: each texel the mean of its block of pixels, slightly blurred in the
// shape of a cross. B. Wronski 2014, "GDC follow-up: Screenspace reflections filtering and up-sampling".
#include "layout/numbers.h"
#include "pass/parameters"
#include "passes/blocks.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D small_colour_image;

const float centre_weight = 0.5, arm_weight = 0.125;

// Sum of the block's colours, and their number: blocks at the border are cut.
vec4 block_sum(ivec2 block)
{
    ivec2 size = imageSize(radiance_image);
    vec4  sum  = vec4(0);
    for (int i = 0; i < block_px * block_px; ++i)
    {
        ivec2 pixel = block * block_px + ivec2(i % block_px, i / block_px);
        if (all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)))
        {
            vec3 colour = imageLoad(radiance_image, pixel).rgb;
            if (hit_shading == hit_shading_lit) colour += imageLoad(highlight_image, pixel).rgb;
            sum += vec4(colour, 1);
        }
    }
    return sum;
}

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block * block_px, imageSize(radiance_image))) || any(greaterThanEqual(block, imageSize(small_colour_image)))) return;
    vec4 sum = centre_weight * block_sum(block) + arm_weight * (block_sum(block - ivec2(1, 0)) + block_sum(block + ivec2(1, 0)) +
                                                                block_sum(block - ivec2(0, 1)) + block_sum(block + ivec2(0, 1)));
    imageStore(small_colour_image, block, vec4(sum.rgb / sum.a, 1));
}
