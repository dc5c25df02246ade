// Appends the mirror ray of each pixel to the list of rays. Set ray_count to 0 before.
#include "api/view.glsl"
#include "rays/segment.glsl"
#include "layout/load_depth.glsl"
#include "layout/store_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, scalar) buffer RayCount { uint ray_count; };
STORED_TEXELS_4(5, Rays)

// Whether a ray starts at a pixel: where there is a surface with a usable normal. A host asks here, too, whether the material reflects.
bool has_ray(ivec2 pixel)
{
    vec3 normal = imageLoad(normal_image, pixel).xyz;
    return load_depth(pixel) > 0.0 && any(notEqual(normal, vec3(0))) && !any(isnan(normal)) && !any(isinf(normal));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size_px)) || !has_ray(pixel)) return;
    real2     start_px  = real2(pixel) + real(0.5);
    Df64x3    direction = mirrored(view_direction(start_px), normal_at(pixel));
    PackedRay made      = segment_to_packed_ray(make_segment(start_px, real(load_depth(pixel)), direction), pixel);
    uint      place     = atomicAdd(ray_count, 1);
    STORE_RAY(Rays, place, made);
}
