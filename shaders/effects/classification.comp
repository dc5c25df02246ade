// Marks in each tile of 8 x 8 pixels those to trace, and counts what the plan of the frame asks about.
#include "shared.h"
#include "reflecting.glsl"
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_EVERY_SURFACE) const int every_surface = 0; // trace what does not reflect, too
layout(constant_id = CONSTANT_TRACE_BLOCK_PX) const int block_px = 1;     // one pixel of each block that reflects

layout(set = 0, binding = 11, scalar) writeonly buffer TileMasks { uvec2 tile_masks[]; }; // bit x + 8 y of a tile, in x and y
layout(set = 0, binding = 6, scalar) buffer PictureStatistics // struct PictureCounts of render/effects.h
{
    uint surface_pixels;
    uint reflecting_pixels;
    uint reflecting_tiles;
    uint roughness_pixels[ROUGHNESS_BINS];
};

shared uint surfaces, mirrors, traced_mask[2];
shared int  first_rank[16]; // of the pixels that reflect, for each block of the tile

// The pixels of a block from its centre outward, row by row where equally far.
int rank_in_block(ivec2 pixel)
{
    ivec2 place  = pixel % block_px;
    ivec2 offset = 2 * place - (block_px - 1);
    return (offset.x * offset.x + offset.y * offset.y) * 16 + place.y * block_px + place.x;
}

// A block is traced from the first of its pixels that reflects. Called by all invocations.
bool first_of_block(ivec2 pixel, bool reflecting)
{
    ivec2 block = pixel % 8 / block_px;
    int   index = block.y * (8 / block_px) + block.x;
    if (gl_LocalInvocationIndex < 16) first_rank[gl_LocalInvocationIndex] = 1 << 16;
    barrier();
    if (reflecting) atomicMin(first_rank[index], rank_in_block(pixel));
    barrier();
    return reflecting && first_rank[index] == rank_in_block(pixel);
}

void main()
{
    uint place = gl_LocalInvocationIndex;
    if (place == 0) surfaces = mirrors = traced_mask[0] = traced_mask[1] = 0;
    barrier();
    ivec2 pixel   = ivec2(gl_GlobalInvocationID.xy);
    bool  inside  = all(lessThan(pixel, imageSize(depth_image)));
    bool  surface = inside && has_surface(pixel);
    bool  mirror  = surface && reflects(pixel);
    bool  traced  = mirror || (every_surface != 0 && surface);
    if (block_px > 1) traced = first_of_block(pixel, mirror) || (traced && !mirror);
    uint  surface_count = subgroupAdd(uint(surface)), mirror_count = subgroupAdd(uint(mirror));
    if (subgroupElect())
    {
        atomicAdd(surfaces, surface_count);
        atomicAdd(mirrors, mirror_count);
    }
    if (traced) atomicOr(traced_mask[place / 32], 1u << place % 32);
    if (mirror)
    {
        float roughness = imageLoad(normal_image, pixel).w;
        // Bin 0 holds perfect mirrors alone.
        int bin = roughness > 0.0 ? clamp(int(ceil(roughness * float(ROUGHNESS_BINS - 1))), 1, ROUGHNESS_BINS - 1) : 0;
        atomicAdd(roughness_pixels[bin], 1);
    }
    barrier();
    if (place != 0) return;
    if (surfaces > 0) atomicAdd(surface_pixels, surfaces);
    if (mirrors > 0)
    {
        atomicAdd(reflecting_pixels, mirrors);
        atomicAdd(reflecting_tiles, 1);
    }
    tile_masks[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = uvec2(traced_mask[0], traced_mask[1]);
}
