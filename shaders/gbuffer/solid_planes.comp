// The planes of pixels once more, with the solids behind them.
#include "api/view.glsl"
#include "layout/memory_layout.glsl"
#include "surfaces/plane/place.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, r32f) uniform readonly image2D solid_image;
layout(set = 0, binding = 5, r32ui) uniform readonly uimage2D gradient_image;
STORED_BUFFER_2(6, pixel_planes, uvec2, uvec2)

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px))) return;
    store_pixel_planes(plane_place(pixel), uvec2(imageLoad(gradient_image, pixel).x, floatBitsToUint(imageLoad(solid_image, pixel).x)));
}
