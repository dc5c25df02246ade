// The list of rays: those of each pixel that is marked in a listed tile, one pixel's after the other's. Other pixels leave no trace in it. It holds
// the rays, ready to trace, or their pixels alone (rays/store_listed.rays_of_pixels.glsl).
#include "api/view.glsl"
#include "rays/tiles.glsl"
#include "layout/frame_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_RAYS_PER_PIXEL) const int rays_per_pixel = 1;

#include "rays/store_listed.glsl"
LOADED_TEXELS_1(11, TileMasks) // two words a tile: bit x + 8 y

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel)) return;
    ivec2 tile  = listed_tile();
    int   own   = 2 * (tile.y * ((size_px.x + 7) / 8) + tile.x);
    uvec2 mask  = uvec2(LOAD_TEXEL(TileMasks, own).x, LOAD_TEXEL(TileMasks, own + 1).x);
    uint  place = gl_LocalInvocationIndex, bit = 1u << place % 32;
    bool  upper = place >= 32;
    if (((upper ? mask.y : mask.x) & bit) == 0) return;

    uint before = bitCount((upper ? mask.y : mask.x) & (bit - 1)) + (upper ? bitCount(mask.x) : 0);
    uint first  = (pixels_before_tile() + before) * rays_per_pixel;
    for (int ray = 0; ray < rays_per_pixel; ++ray) store_ray(first + ray, pixel, ray);
}
