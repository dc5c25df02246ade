// Directions and normals in view space, for techniques and surface models.
#include "api/view.glsl"
#include "layout/normal_image.glsl"

// From the ray's origin to a position of some depth, not normalised.
real3 direction_to_vs(Ray ray, real2 position_px, real depth)
{
    return px_to_direction_vs(ray.origin, real3(position_px, depth));
}

// Of the ray, not normalised.
real3 direction_vs(Ray ray) { return px_to_direction_vs(ray.origin, ray.origin + ray.delta); }

// Normal of a pixel; not counted.
real3 fetch_normal(ivec2 pixel) { return real3(imageLoad(normal_image, pixel).xyz); }

#include "api/layer_normals.glsl"
