// Rays ready to trace: for each pixel that is marked in a listed tile the screen-space segment of its mirror ray. Other pixels leave no trace in
// the list. By the passes' parameters there may be several rays per pixel, one after the other in the list.
#include "rays/segment.glsl"
#include "api/hash.glsl"
#include "rays/lobe.glsl"
#include "rays/tiles.glsl"
#include "layout/frame_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = CONSTANT_RAYS_PER_PIXEL) const int rays_per_pixel = 1;
layout(constant_id = CONSTANT_LOBE_RAYS) const int lobe_rays = 0; // rough surfaces: drawn from the lobe, else the mirror ray

STORED_TEXELS_4(5, Rays)
LOADED_TEXELS_1(11, TileMasks) // two words a tile: bit x + 8 y

// A place inside the pixel, exact in float. Depth is flat inside each pixel: a ray that starts on the far side of its pixel's
// centre and runs sideways is behind its neighbour's slab face, which ray_offset_m > 0 avoids.
real2 offset_start(ivec2 pixel, int ray)
{
    uint  random = pcg(uint(pixel.x) + pcg(uint(pixel.y) + pcg(uint(ray) + offset_seed())));
    uvec2 cell   = uvec2(random, random >> 16) % OFFSET_CELLS;
    return real2(pixel) + (real2(cell) + real(0.5)) / real(OFFSET_CELLS);
}

// Depth at start_px of the plane through the pixel's point with its normal; 0 where that is less than half or more than twice as far
// as the point: the plane is seen edge-on.
real plane_depth(ivec2 pixel, real depth, real3 normal, real2 start_px)
{
    real2 slope = px_to_slope(real2(pixel) + real(0.5)), start_slope = px_to_slope(start_px);
    real  start_depth;
    if (orthographic == 0)
        start_depth = depth * (dot(normal.xy, start_slope) - normal.z) / (dot(normal.xy, slope) - normal.z);
    else
        start_depth = depth - dot(normal.xy, start_slope - slope) / normal.z / (far_m - near_m);
    real farther = depth_to_distance(start_depth) / depth_to_distance(depth);
    bool usable  = start_depth > real(0) && start_depth <= real(1) && farther >= real(0.5) && farther <= real(2);
    return usable ? start_depth : real(0);
}

// The normal at which a rough surface's ray mirrors the view direction. Directions below the horizon are drawn again.
real3 drawn_normal(ivec2 pixel, int ray, real3 normal)
{
    float roughness = imageLoad(normal_image, pixel).w;
    if (!(roughness >= mirror_roughness)) return normal;
    vec3 to_eye = orthographic != 0 ? vec3(0, 0, 1) : -normalize(vec3(px_to_slope(real2(pixel) + real(0.5)), -1.0));
    vec3 facing = normalize(vec3(normal));
    facing      = dot(facing, to_eye) < 0.0 ? -facing : facing;
    for (int attempt = 0; attempt < 4; ++attempt)
    {
        vec3 drawn = drawn_half_vector(facing, to_eye, roughness * roughness, lobe_random(pixel, ray, rays_per_pixel, attempt));
        if (dot(facing, reflect(-to_eye, drawn)) > 0.0) return real3(drawn);
    }
    return normal;
}

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

    uint  before = bitCount((upper ? mask.y : mask.x) & (bit - 1)) + (upper ? bitCount(mask.x) : 0);
    uint  index  = (pixels_before_tile() + before) * rays_per_pixel;
    real  depth  = real(load_depth(pixel));
    real3 normal = normal_at(pixel);
    for (int ray = 0; ray < rays_per_pixel; ++ray)
    {
        real2 start_px    = real2(pixel) + real(0.5);
        real  start_depth = depth;
        if (rays_per_pixel > 1 && lobe_rays == 0)
        {
            real2 offset_px    = offset_start(pixel, ray);
            real  offset_depth = plane_depth(pixel, depth, normal, offset_px);
            start_px           = offset_depth > real(0) ? offset_px : start_px;
            start_depth        = offset_depth > real(0) ? offset_depth : depth;
        }
        Segment   segment = make_segment(start_px, start_depth, mirrored(view_direction(start_px), lobe_rays != 0 ? drawn_normal(pixel, ray, normal) : normal));
        PackedRay listed  = segment_to_packed_ray(segment, pixel);
        STORE_RAY(Rays, index + ray, listed);
    }
}
