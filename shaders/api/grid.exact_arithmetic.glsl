// grid.glsl in whole numbers, for arithmetic = exact: both ends of the ray are put on multiples of 1/65536 px, and t is counted in steps of 1 / (|dx| |dy|), where d is the
// ray's extent in those. So every crossing is a whole number below 2^62 at 16384 px, and none is ever rounded.
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define crossing int64_t
#define crossing2 i64vec2

const int steps_per_px = 65536;

struct Grid
{
    ivec2   origin_steps;
    i64vec2 inverse_delta; // 1/dx = |dy| / (|dx| |dy|), signed; beyond every end for a component that is zero
    ivec2   forward;       // 1 where the ray runs toward larger coordinates, else 0
    int64_t whole;         // the step at the end of the ray, t = 1
    int64_t t_end;         // the same, or where the ray crosses the image border before
};

i64vec2 border_t(Ray ray, Grid grid, ivec2 border)
{
    return i64vec2(border * steps_per_px - grid.origin_steps) * grid.inverse_delta;
}

real crossing_to_t(Grid grid, int64_t t) { return real(double(t) / double(grid.whole)); }

// The nearest step, the even one of two: mirrored positions get mirrored steps. round() may break such ties as it likes, and roundEven() of
// doubles breaks them upward on some CPU devices. A sum is rounded by IEEE 754: 1.5 * 2^52 leaves it no fraction.
ivec2 nearest_steps(dvec2 position_px)
{
    const double  no_fraction = 6755399441055744.0LF;
    precise dvec2 steps       = (position_px * double(steps_per_px) + no_fraction) - no_fraction;
    return ivec2(steps);
}

Grid make_grid(Ray ray)
{
    ivec2 from      = nearest_steps(dvec2(ray.origin.xy));
    ivec2 delta     = nearest_steps(dvec2(ray.origin.xy) + dvec2(ray.delta.xy)) - from;
    bvec2 flat_axis = equal(delta, ivec2(0));
    // A ray stays in the column or row that it does not leave: from the middle, so that it stands on no border.
    ivec2 middle  = ray.start_pixel * steps_per_px + steps_per_px / 2;
    ivec2 lengths = max(abs(delta), ivec2(1));
    Grid  grid;
    grid.origin_steps    = ivec2(flat_axis.x ? middle.x : from.x, flat_axis.y ? middle.y : from.y);
    grid.inverse_delta.x = flat_axis.x ? int64_t(1) << 32 : int64_t(sign(delta.x)) * int64_t(lengths.y);
    grid.inverse_delta.y = flat_axis.y ? int64_t(1) << 32 : int64_t(sign(delta.y)) * int64_t(lengths.x);
    grid.forward         = ivec2(greaterThanEqual(delta, ivec2(0)));
    grid.whole           = int64_t(lengths.x) * int64_t(lengths.y);
    i64vec2 t_image      = border_t(ray, grid, grid.forward * size_px);
    grid.t_end           = min(grid.whole, min(t_image.x, t_image.y));
    return grid;
}

// Depths are compared without a division, times `whole` and counted from the ray's origin: what is equal stays equal in both products.
double scaled_depth(Ray ray, int64_t t)
{
    precise double z = double(t) * double(ray.delta.z);
    return z;
}

#include "surface/meeting_exact.glsl"
