// The rays of a pixel: the mirror ray from its centre, several from places inside it, or rays drawn from the lobe of a rough surface.
#include "rays/segment.glsl"
#include "layout/load_depth.glsl"
#include "layout/frame_shared.h"
#include "api/hash.glsl"
#include "rays/lobe.glsl"

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

// The share of a lobe, about its mirror direction, from which rays are drawn: all of a wide one. Where a lobe spans few pixels, few
// neighbours' rays meet the same things, and the noise of single rays is larger than the error of a narrower lobe. Its half width is
// measured where what it meets is as far from the surface as the camera is.
float lobe_share(float alpha)
{
    const float whole_lobe_px = 11; // of 6 to 20 the best over ten scenes
    float half_width_px = 1.3 * alpha * float(focal_px.y); // 1.3 alpha: where GGX has fallen to a half
    return orthographic != 0 ? 1.0 : min(half_width_px / whole_lobe_px, 1.0);
}

// The normal at which a rough surface's ray mirrors the view direction. Directions below the horizon are drawn again.
real3 drawn_normal(ivec2 pixel, int ray, int rays_per_pixel, real3 normal)
{
    float roughness = imageLoad(normal_image, pixel).w;
    if (!(roughness >= mirror_roughness)) return normal;
    vec3 to_eye = orthographic != 0 ? vec3(0, 0, 1) : -normalize(vec3(px_to_slope(real2(pixel) + real(0.5)), -1.0));
    vec3 facing = normalize(vec3(normal));
    facing      = dot(facing, to_eye) < 0.0 ? -facing : facing;
    float alpha = roughness * roughness;
    vec2  share = vec2(lobe_share(alpha), 1);
    for (int attempt = 0; attempt < 4; ++attempt)
    {
        vec3 drawn = drawn_half_vector(facing, to_eye, alpha, lobe_random(pixel, ray, rays_per_pixel, attempt) * share);
        if (dot(facing, reflect(-to_eye, drawn)) > 0.0) return real3(drawn);
    }
    return normal;
}

// One of them.
PackedRay pixel_ray(ivec2 pixel, int ray, int rays_per_pixel, bool from_lobe)
{
    real2 start_px    = real2(pixel) + real(0.5);
    real  start_depth = real(load_depth(pixel));
    real3 normal      = normal_at(pixel);
    if (rays_per_pixel > 1 && !from_lobe)
    {
        real2 offset_px    = offset_start(pixel, ray);
        real  offset_depth = plane_depth(pixel, start_depth, normal, offset_px);
        start_px           = offset_depth > real(0) ? offset_px : start_px;
        start_depth        = offset_depth > real(0) ? offset_depth : start_depth;
    }
    real3 mirror_normal = from_lobe ? drawn_normal(pixel, ray, rays_per_pixel, normal) : normal;
    return segment_to_packed_ray(make_segment(start_px, start_depth, mirrored(view_direction(start_px), mirror_normal)), pixel);
}
