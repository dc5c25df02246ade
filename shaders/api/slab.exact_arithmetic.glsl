// slab.glsl for arithmetic = exact: the same slab, in double precision, whatever the number type of the trace.
#include "api/slab_constants.glsl"

double slab_back_of(double depth)
{
    precise double back = (depth * slab_scale - slab_shift) / (double(1) + depth * slab_slope);
    return back;
}
real slab_back(real depth) { return real(slab_back_of(double(depth))); }
