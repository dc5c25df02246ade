#include "api/view.glsl"
#include "structure/buffers"
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    ivec2 first = 4 * ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(first, size_px))) return;
    float farthest = 1;
    for (int i = 0; i < 16; ++i)
    {
        ivec2 pixel = min(first + ivec2(i % 4, i / 4), size_px - 1);
        farthest    = min(farthest, max(depth_in(load_cell(pixel, 0), pixel), 0.0));
    }
    store_farthest(tile_index(first, 4), farthest);
}
