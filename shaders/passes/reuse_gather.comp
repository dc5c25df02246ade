// Packs into one texel what passes/ray_reuse.comp reads of each neighbour besides its rays. Where nothing reflects, the
// filters after it read the same texel.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/reflector.glsl"
#include "passes/reused_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D reflection_image;
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D reused_image;
layout(set = 0, binding = 11, rgba32ui) uniform writeonly uimage2D gathered_image;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    vec4  light = imageLoad(reflection_image, pixel);
    uvec4 texel = pack_reused(ReusedPixel(light, load_depth(pixel), 0.0, 0.0));
    imageStore(gathered_image, pixel, texel);
    if (!is_reflection(light)) imageStore(reused_image, pixel, texel); // its tile may not be listed
}
