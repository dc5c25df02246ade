// How a classification ends: its last workgroup lists the tiles. From the masks of all: which tiles are listed, how many pixels are traced in those
// before each, and how many rays there will be. Tiles traced as a whole come first, so that their rays fill groups of RAYS_PER_GROUP; both parts row by
// row. The same picture gives the same list. The launches of what works on tiles and rays follow from both numbers.
#include "trace/ray_launches.glsl"

layout(constant_id = CONSTANT_RAYS_PER_PIXEL) const int rays_per_pixel = 1;

layout(set = 0, binding = 5, scalar) writeonly buffer TileLaunch { uvec3 tile_launch; };
layout(set = 0, binding = 4, scalar) writeonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 9, scalar) coherent buffer TileCount { uint tile_count, finished_workgroups; }; // the latter 0 between frames
layout(set = 0, binding = 10, scalar) writeonly buffer Tiles { uvec2 tiles[]; };

// x: tiles traced as a whole, y: others, z: pixels of these
shared uvec3 share_counts[CLASSIFICATION_INVOCATIONS];
shared bool  all_marked;

uint pixels_of(uint tile)
{
    uvec2 mask = tile_masks[tile];
    return bitCount(mask.x) + bitCount(mask.y);
}

uvec3 count_of(uint pixels)
{
    return pixels == 64 ? uvec3(1, 0, 0) : uvec3(0, pixels > 0 ? 1 : 0, pixels);
}

// All invocations of a workgroup call it, with their masks stored.
void list_tiles()
{
    memoryBarrierBuffer();
    barrier();
    if (gl_LocalInvocationIndex == 0)
    {
        all_marked = atomicAdd(finished_workgroups, 1) == gl_NumWorkGroups.x * gl_NumWorkGroups.y - 1;
        if (all_marked) finished_workgroups = 0;
    }
    barrier();
    if (!all_marked) return;
    memoryBarrierBuffer();

    uint all = size_tiles.x * size_tiles.y, share = (all + CLASSIFICATION_INVOCATIONS - 1) / CLASSIFICATION_INVOCATIONS;
    uint own = gl_LocalInvocationIndex, first = min(own * share, all), last = min(first + share, all);

    uvec3 count = uvec3(0);
    for (uint tile = first; tile < last; ++tile) count += count_of(pixels_of(tile));
    share_counts[own] = count;
    barrier();
    // Sums over twice as many shares each time (Hillis and Steele 1986, Data Parallel Algorithms).
    for (uint reach = 1; reach < CLASSIFICATION_INVOCATIONS; reach *= 2)
    {
        uvec3 further = own >= reach ? share_counts[own - reach] : uvec3(0);
        barrier();
        share_counts[own] += further;
        barrier();
    }
    uvec3 before = share_counts[own] - count, total = share_counts[CLASSIFICATION_INVOCATIONS - 1];

    for (uint tile = first; tile < last; ++tile)
    {
        uint pixels = pixels_of(tile);
        bool whole  = pixels == 64;
        uint place = whole ? before.x : total.x + before.y, pixels_before = whole ? 64 * before.x : 64 * total.x + before.z;
        if (pixels > 0) tiles[place] = uvec2(tile % size_tiles.x | tile / size_tiles.x << 16, pixels_before);
        before += count_of(pixels);
    }
    if (own == 0)
    {
        uint listed = total.x + total.y, rays = (64 * total.x + total.z) * rays_per_pixel;
        tile_count  = listed;
        ray_count   = rays;
        tile_launch = launch_of(listed, 1);
        store_ray_launches(rays);
    }
}
