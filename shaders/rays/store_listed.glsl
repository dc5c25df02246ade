// Makes a ray of a pixel and stores it.
#include "rays/pixel_ray.glsl"
#include "layout/frame_shared.h"
#include "layout/store_ray.glsl"

layout(constant_id = CONSTANT_LOBE_RAYS) const int lobe_rays = 0; // rough surfaces: drawn from the lobe, else the mirror ray

STORED_TEXELS_4(5, Rays)

void store_ray(uint index, ivec2 pixel, int ray)
{
    PackedRay made = pixel_ray(pixel, ray, rays_per_pixel, lobe_rays != 0);
    STORE_RAY(Rays, index, made);
}
