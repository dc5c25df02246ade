// The list of rays, for shaders that read it (rays.comp writes it). ray_list.rays_of_pixels.glsl reads a list that holds pixels alone.
#include "layout/packed_ray.glsl"

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
LOADED_TEXELS_4(5, Rays)

PackedRay packed_ray(uint index) { return LOAD_RAY(Rays, index); }

// pack_pixel() of the pixel and of the status of a miss.
uint ray_pixel(uint index) { return LOAD_RAY_PIXEL(Rays, index); }
