// What the two forms of the classification share: what they read, what they write, and what they count before a frame is planned.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "layout/frame_shared.h"

ivec2 size_tiles = (size_px + 7) / 8;

layout(constant_id = CONSTANT_EVERY_SURFACE) const int every_surface = 0; // trace what does not reflect, too
layout(constant_id = CONSTANT_TRACE_BLOCK_PX) const int block_px = 1;     // one pixel of each block that reflects

layout(constant_id = CONSTANT_COUNTS_PIXELS) const int counts_pixels = 0; // for the plan; a planned frame marks and lists

layout(set = 0, binding = 11, scalar) coherent buffer TileMasks { uvec2 tile_masks[]; }; // bit x + 8 y of a tile, in x and y
layout(set = 0, binding = 6, scalar) buffer PictureStatistics // struct GBufferCounts of trace/counts.h
{
    uint surface_pixels;
    uint reflecting_pixels;
    uint reflecting_tiles;
    uint roughness_pixels[ROUGHNESS_BINS];
};

#include "rays/tile_list.glsl"

// The pixels of a block from its centre outward, row by row where equally far.
int rank_in_block(ivec2 place)
{
    ivec2 offset = 2 * place - (block_px - 1);
    return (offset.x * offset.x + offset.y * offset.y) * 16 + place.y * block_px + place.x;
}

// Bin 0 holds perfect mirrors alone.
int roughness_bin(float roughness)
{
    return roughness > 0.0 ? clamp(int(ceil(roughness * float(ROUGHNESS_BINS - 1))), 1, ROUGHNESS_BINS - 1) : 0;
}
