// The slab of a depth sample (docs/reference/hit_contract.md) in one form for all views and thickness rules:
//   slab_back(d) = (d * scale - shift) / (1 + d * slope)
//   perspective   absolute: slope = thickness / near        relative: scale = 1 / (1 + thickness)
//   orthographic  absolute: shift = thickness / (far - near)  relative: scale = 1 + thickness, shift = thickness * far / (far - near)
//   infinite thickness: scale = 0
// SURFACE_ENDLESS and SURFACE_TWO_SIDED are what a surface model's manifest defines.
#include "layout/shared.h"
#ifdef EXACT_ARITHMETIC
#define slab_real double // the same slab whatever the number type of the trace
#else
#define slab_real real
#endif
#ifdef SURFACE_ENDLESS
const slab_real slab_slope = 0, slab_scale = 0, slab_shift = 0;
#else
layout(constant_id = CONSTANT_SLAB_SLOPE) const slab_real slab_slope = 0;
layout(constant_id = CONSTANT_SLAB_SCALE) const slab_real slab_scale = 1;
layout(constant_id = CONSTANT_SLAB_SHIFT) const slab_real slab_shift = 0;
#endif

#ifdef SURFACE_TWO_SIDED
#include "api/slab_two_sided.glsl"
#else
slab_real slab_front_of(slab_real depth) { return depth; }
real      slab_front(real depth) { return depth; }
#endif

// Does the depth interval that ends at z_near (its nearest depth) reach the slab's back? Multiplied out: a division is not correctly
// rounded on every device, and it is slower.
bool reaches_slab_back(real depth, real z_near)
{
    precise real left  = z_near + (z_near * depth) * real(slab_slope);
    precise real right = depth * real(slab_scale) - real(slab_shift);
    return left >= right;
}

slab_real slab_back_of(slab_real depth)
{
    precise slab_real back = (depth * slab_scale - slab_shift) / (slab_real(1) + depth * slab_slope);
    return back;
}
real slab_back(real depth) { return real(slab_back_of(slab_real(depth))); }
