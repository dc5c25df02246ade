// Lists the 8 x 8 tiles that hold a pixel to trace, and counts what the plan of the frame asks about.
#include "shared.h"
#include "reflecting.glsl"
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_EVERY_SURFACE) const int every_surface = 0; // trace what does not reflect, too

layout(set = 0, binding = 4, scalar) buffer TileCount { uint tile_count; };
layout(set = 0, binding = 5, scalar) writeonly buffer Tiles { uint tiles[]; }; // x | y << 16, in tiles
layout(set = 0, binding = 6, scalar) buffer PictureStatistics // struct PictureCounts of render/effects.h
{
    uint surface_pixels;
    uint reflecting_pixels;
    uint reflecting_tiles;
    uint roughness_pixels[ROUGHNESS_BINS];
};

shared uint surfaces, mirrors;

void main()
{
    if (gl_LocalInvocationIndex == 0) surfaces = mirrors = 0;
    barrier();
    ivec2 pixel   = ivec2(gl_GlobalInvocationID.xy);
    bool  inside  = all(lessThan(pixel, imageSize(depth_image)));
    bool  surface = inside && has_surface(pixel);
    bool  mirror  = surface && reflects(pixel);
    uint  surface_count = subgroupAdd(uint(surface)), mirror_count = subgroupAdd(uint(mirror));
    if (subgroupElect())
    {
        atomicAdd(surfaces, surface_count);
        atomicAdd(mirrors, mirror_count);
    }
    if (mirror)
    {
        float roughness = imageLoad(normal_image, pixel).w;
        // Bin 0 holds perfect mirrors alone.
        int bin = roughness > 0.0 ? clamp(int(ceil(roughness * float(ROUGHNESS_BINS - 1))), 1, ROUGHNESS_BINS - 1) : 0;
        atomicAdd(roughness_pixels[bin], 1);
    }
    barrier();
    if (gl_LocalInvocationIndex != 0) return;
    if (surfaces > 0) atomicAdd(surface_pixels, surfaces);
    if (mirrors > 0)
    {
        atomicAdd(reflecting_pixels, mirrors);
        atomicAdd(reflecting_tiles, 1);
    }
    bool listed = mirrors > 0 || (every_surface != 0 && surfaces > 0);
    if (listed) tiles[atomicAdd(tile_count, 1)] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16;
}
