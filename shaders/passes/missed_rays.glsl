// Rays of reflecting pixels that found no surface that the frame shows: they missed, or stopped at the unseen side of something. One in each
// block of pixels is followed through the scene's triangles, on behalf of the others.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "trace/ray_list.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "api/hash.glsl"
#include "rays/lobe.glsl"
#include "passes/scene_frame.glsl"
#include "world/rays.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;

const uint no_rank = 0xFFFFFFFFu;

ivec2 miss_blocks() { return (size_px - 1) / MISS_BLOCK_PX + 1; }
int   miss_block(ivec2 pixel) { return pixel.y / MISS_BLOCK_PX * miss_blocks().x + pixel.x / MISS_BLOCK_PX; }

// The least of a block is followed: in a random order, and the same in whichever order the rays are listed.
uint miss_rank(ivec2 pixel, uint ray)
{
    uint random = pcg(uint(pixel.x) + pcg(uint(pixel.y) + pcg(ray + offset_seed())));
    uvec2 place = uvec2(pixel) % MISS_BLOCK_PX;
    return (random & 0x7FFFF000u) | (place.y * MISS_BLOCK_PX + place.x) << 8 | ray;
}

vec3 direction_vs(PackedRay ray) { return normalize(px_to_direction_vs(ray.origin, ray.origin + ray.delta)); }

// In world space.
WorldRay missed_ray(uint index)
{
    PackedRay ray      = packed_ray(index);
    vec3 origin_vs     = px_to_vs(ray.origin);
    mat3 view_to_world = transpose(mat3(world_to_view));
    float eye_m        = orthographic != 0 ? -origin_vs.z : length(origin_vs);
    return WorldRay(view_to_world * (origin_vs - world_to_view[3].xyz), MISS_START_SHARE * eye_m,
                    view_to_world * direction_vs(ray), min(max_distance_m, 1e37),
                    imageLoad(normal_image, unpack_pixel(ray.pixel)).w);
}
