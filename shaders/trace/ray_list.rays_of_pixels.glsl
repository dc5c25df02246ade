// ray_list.glsl where the list holds a word for each ray, its pixel: whoever reads a ray makes it anew, bit by bit the same. RAYS_OF_PIXELS: the
// rays of a pixel.
#include "rays/pixel_ray.glsl"

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
LOADED_TEXELS_1(5, Rays)

// pack_pixel() of the pixel; above it, undefined bits.
uint ray_pixel(uint index) { return LOAD_TEXEL(Rays, index).x; }

PackedRay packed_ray(uint index)
{
    return pixel_ray(unpack_pixel(ray_pixel(index)), int(index % RAYS_OF_PIXELS), RAYS_OF_PIXELS, RAYS_FROM_LOBE != 0);
}
