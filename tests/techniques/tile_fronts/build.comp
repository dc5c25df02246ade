#include "api/view.glsl"
#include "api/slab.glsl"
#include "api/held.glsl"
#include "structure/buffers"
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    ivec2 first = 8 * ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(first, size_px))) return;
    float front = BACKGROUND_DEPTH;
    for (int i = 0; i < 64; ++i)
    {
        // Not the depth alone: a plane may be nearer at its pixel's border.
        ivec2 pixel = min(first + ivec2(i % 8, i / 8), size_px - 1);
        uvec2 words = load_cell(pixel, 0);
        front       = max(front, held_depths(pixel, depth_in(words, pixel), words.y).x);
    }
    store_fronts(tile_index(first, 8), front);
}
