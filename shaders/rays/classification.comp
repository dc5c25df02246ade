// Marks in each tile of 8 x 8 pixels those to trace, or counts what the plan of the frame asks about, too. A tile per invocation: what its
// pixels share needs neither shared memory nor an atomic per pixel, which CPU devices run lane by lane.
#include "rays/classified.glsl"
#if ROUGHNESS_BINS != 16
#error four bins in each of four words
#endif

layout(local_size_x = CLASSIFICATION_INVOCATIONS) in;

void mark(ivec2 tile)
{
    const int per_block = block_px * block_px, blocks_x = 8 / block_px;
    uvec2     mask = uvec2(0), first = uvec2(0); // of the tile; of the pixel from which the block is traced
    int       first_rank = 1 << 16;
    uint      surfaces = 0, mirrors = 0;
    uvec4     roughness = uvec4(0); // four bins each, a byte a bin
    for (int i = 0; i < 64; ++i) // block after block
    {
        int   block = i / per_block, inner = i % per_block;
        ivec2 place = ivec2(inner % block_px, inner / block_px), in_tile = ivec2(block % blocks_x, block / blocks_x) * block_px + place;
        ivec2 pixel = tile * 8 + in_tile;
        vec4  normal  = imageLoad(normal_image, pixel);
        bool  inside  = all(lessThan(pixel, size_px));
        bool  surface = inside && is_surface(load_depth(pixel), normal.xyz);
        bool  mirror  = surface && material_reflects(pixel);
        if (counts_pixels != 0)
        {
            surfaces += uint(surface);
            mirrors += uint(mirror);
            int bin = roughness_bin(normal.w);
            roughness += uvec4(equal(ivec4(bin >> 2), ivec4(0, 1, 2, 3))) * (uint(mirror) << 8 * (bin & 3));
        }

        uint  bit  = 1u << (in_tile.x + 8 * (in_tile.y & 3));
        uvec2 own  = in_tile.y < 4 ? uvec2(bit, 0) : uvec2(0, bit);
        int   rank = mirror ? rank_in_block(place) : 1 << 16;
        first      = rank < first_rank ? own : first;
        first_rank = min(rank, first_rank);
        bool last  = inner == per_block - 1;
        mask |= (last ? first : uvec2(0)) | (every_surface != 0 && surface && !mirror ? own : uvec2(0));
        first      = last ? uvec2(0) : first;
        first_rank = last ? 1 << 16 : first_rank;
    }
    tile_masks[tile.y * size_tiles.x + tile.x] = mask;
    if (surfaces > 0) atomicAdd(surface_pixels, surfaces);
    if (mirrors == 0) return;
    atomicAdd(reflecting_pixels, mirrors);
    atomicAdd(reflecting_tiles, 1);
    for (int bin = 0; bin < ROUGHNESS_BINS; ++bin)
    {
        uint count = roughness[bin >> 2] >> 8 * (bin & 3) & 0xFFu;
        if (count > 0) atomicAdd(roughness_pixels[bin], count);
    }
}

void main()
{
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(tile, size_tiles))) mark(tile);
    if (counts_pixels == 0) list_tiles();
}
