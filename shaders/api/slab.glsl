// The slab of a depth sample (docs/reference/hit_contract.md) in one form for all views and thickness rules:
//   slab_back(d) = (d * scale - shift) / (1 + d * slope)
//   perspective   absolute: slope = thickness / near        relative: scale = 1 / (1 + thickness)
//   orthographic  absolute: shift = thickness / (far - near)  relative: scale = 1 + thickness, shift = thickness * far / (far - near)
//   infinite thickness: scale = 0
// After api/camera.glsl.
#include "api/slab_constants.glsl"

real slab_back(real depth)
{
    precise real back = (depth * slab_scale - slab_shift) / (real(1) + depth * slab_slope);
    return back;
}
