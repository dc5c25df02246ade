// The same as classification.comp, an invocation a pixel: for devices whose passes are parallel. What the pixels of a tile share is counted by subgroups.
#include "rays/classified.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

const int group_tiles = CLASSIFICATION_INVOCATIONS / 64;

layout(local_size_x = CLASSIFICATION_INVOCATIONS) in;

shared uint mirrors[2 * group_tiles], marks[2 * group_tiles]; // two words a tile, as tile_masks
shared uint surfaces, roughness[ROUGHNESS_BINS];

// Of these pixels of a tile, is it the first of its block?
bool first_of_block(uvec2 pixels, ivec2 in_tile)
{
    ivec2 corner = in_tile / block_px * block_px;
    int   rank   = rank_in_block(in_tile - corner);
    bool  first  = true;
    for (int inner = 0; inner < block_px * block_px; ++inner)
    {
        ivec2 place = ivec2(inner % block_px, inner / block_px), other = corner + place;
        bool  set   = (pixels[other.y >> 2] >> (other.x + 8 * (other.y & 3)) & 1u) != 0;
        first       = first && !(set && rank_in_block(place) < rank);
    }
    return first;
}

// Sets the bits of those pixels; `place` is the invocation's in the tile. A subgroup has 4 to 64 pixels of one tile, in their order.
#define SET_BITS(MASKS, TILE, PLACE, FLAG)                                          \
    {                                                                               \
        uvec4 flags = subgroupBallot(FLAG);                                         \
        if (subgroupElect())                                                        \
        {                                                                           \
            atomicOr(MASKS[2 * (TILE) + ((PLACE) >> 5)], flags.x << ((PLACE) & 31)); \
            if (gl_SubgroupSize > 32) atomicOr(MASKS[2 * (TILE) + 1], flags.y);     \
        }                                                                           \
    }

void main()
{
    const uint index = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
    if (index < 2 * group_tiles)
    {
        mirrors[index] = 0;
        marks[index]   = 0;
    }
    if (index < ROUGHNESS_BINS) roughness[index] = 0;
    if (index == 0) surfaces = 0;
    barrier();

    const ivec2 first_tile = ivec2(gl_WorkGroupID.x * group_tiles, gl_WorkGroupID.y);
    const uint  own = index >> 6, place = index & 63;
    const ivec2 in_tile = ivec2(place & 7, place >> 3), pixel = (first_tile + ivec2(own, 0)) * 8 + in_tile;
    bool inside  = all(lessThan(pixel, size_px));
    vec4 normal  = inside ? imageLoad(normal_image, pixel) : vec4(0);
    bool surface = inside && is_surface(load_depth(pixel), normal.xyz);
    bool mirror  = surface && material_reflects(pixel);
    SET_BITS(mirrors, own, place, mirror)
    if (counts_pixels != 0)
    {
        uint count = subgroupBallotBitCount(subgroupBallot(surface));
        if (count > 0 && subgroupElect()) atomicAdd(surfaces, count);
        int bin = mirror ? roughness_bin(normal.w) : ROUGHNESS_BINS;
        for (bool left = mirror; left;)
        {
            bool alike = subgroupBroadcastFirst(bin) == bin;
            uint many  = subgroupBallotBitCount(subgroupBallot(alike));
            if (subgroupElect()) atomicAdd(roughness[bin], many);
            left = !alike;
        }
    }
    barrier();
    uvec2 reflecting = uvec2(mirrors[2 * own], mirrors[2 * own + 1]);
    bool  marked     = mirror ? first_of_block(reflecting, in_tile) : every_surface != 0 && surface;
    SET_BITS(marks, own, place, marked)
    barrier();

    const ivec2 tile = first_tile + ivec2(index, 0);
    if (index < group_tiles && all(lessThan(tile, size_tiles)))
    {
        tile_masks[tile.y * size_tiles.x + tile.x] = uvec2(marks[2 * index], marks[2 * index + 1]);
        uint count = counts_pixels == 0 ? 0 : bitCount(mirrors[2 * index]) + bitCount(mirrors[2 * index + 1]);
        if (count > 0)
        {
            atomicAdd(reflecting_tiles, 1);
            atomicAdd(reflecting_pixels, count);
        }
    }
    if (index < ROUGHNESS_BINS && roughness[index] > 0) atomicAdd(roughness_pixels[index], roughness[index]);
    if (index == 0 && surfaces > 0) atomicAdd(surface_pixels, surfaces);
    if (counts_pixels == 0) list_tiles();
}
