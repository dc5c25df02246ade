// The list of rays, for shaders that read it (rays/rays.comp writes it). It holds the rays, or with RAYS_OF_PIXELS, the rays of a pixel, a word for
// each: its pixel. Then whoever reads a ray makes it anew, bit by bit the same.
#ifndef SSRLAB_RAY_LIST
#define SSRLAB_RAY_LIST
#include "layout/packed_ray.glsl"
#ifdef RAYS_OF_PIXELS
#include "rays/pixel_ray.glsl"
#endif

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
#ifdef RAYS_OF_PIXELS
LOADED_TEXELS_1(5, Rays)

// pack_pixel() of the pixel; above it, undefined bits.
uint ray_pixel(uint index) { return LOAD_TEXEL(Rays, index).x; }

PackedRay packed_ray(uint index)
{
    return pixel_ray(unpack_pixel(ray_pixel(index)), int(index % RAYS_OF_PIXELS), RAYS_OF_PIXELS, RAYS_FROM_LOBE != 0);
}
#else
LOADED_TEXELS_4(5, Rays)

uint ray_pixel(uint index) { return LOAD_RAY_PIXEL(Rays, index); }

PackedRay packed_ray(uint index) { return LOAD_RAY(Rays, index); }
#endif
#endif
