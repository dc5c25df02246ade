// What a technique sees: a ray that is ready, counted fetches, the hit contract, and results that say why they stopped.
// A technique defines    TraceResult trace(Ray ray)
// or, with #define TRACES_PAIRS,    void trace_pair(Ray a, Ray b, out TraceResult result_a, out TraceResult result_b)
//
// Loops end in their condition, never by break or return: on lavapipe (Mesa 22.3) lanes that have left a loop go through its body again until the
// last lane leaves, and what the loop made and is used after it gets another iteration's value. A short loop around much work ends at the bottom
// (docs/performance.md); its body must leave what is used after it as it is once the condition is false.
#ifdef EXACT_ARITHMETIC
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif
#include "api/view.glsl"
#include "layout/depth.glsl"
#include "api/slab.glsl"
#include "pyramid_cell.glsl"
#include "api/hash.glsl"
#include "layout/work_group.glsl"

layout(constant_id = CONSTANT_FACING) const int facing_rule = 0;
layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1;

layout(set = 0, binding = 2, rgba32f) uniform readonly image2D normal_image;
// The pixels' depths, two in the place of a cell, and below them levels 1, 2, …: what depth.glsl reads word by word.
layout(set = 0, binding = 3, rg32ui) uniform readonly uimageBuffer depth_pyramid;

struct Ray
{
    real3 origin;      // x_px, y_px, depth at t = 0
    real3 delta;       // from there to the end of the segment, t = 1; the whole segment lies on the image
    ivec2 start_pixel; // never counts as a hit
    real  length_m;    // length of the segment in view space; may be infinite
    int   end_status;  // how the ray ends if it hits nothing
    real  rounding;    // how far rounding may move its depth
};

struct TraceResult
{
    int   status; // TRACE_*
    ivec2 pixel;  // the pixel that was hit; undefined unless TRACE_HIT
    real  t;      // where the ray first meets the slab inside that pixel; undefined unless TRACE_HIT
    int   steps;  // loop iterations
};

// The ray that is worked on: 0, of a pair also 1; 2 counts for none.
int current_ray = 0;

// ---- Work counters: compiled out of the pipelines that are timed.
#ifdef COUNT_WORK
uint depth_fetches[3]   = uint[3](0, 0, 0);
uint pyramid_fetches[3] = uint[3](0, 0, 0);
#define COUNT_IF(counter, condition) counter[current_ray] += uint(condition)
#else
#define COUNT_IF(counter, condition)
#endif
#define COUNT(counter) COUNT_IF(counter, true)

// Set when a surface would have been hit but faces away.
bool met_facing_away[3] = bool[3](false, false, false);

// ---- The ray
real depth_at(Ray ray, real t)
{
    precise real depth = ray.origin.z + t * ray.delta.z; // not mix(): that is not monotone in t
    return depth;
}

ivec2 pixel_at(Ray ray, real t)
{
    real2 position_px = ray.origin.xy + t * ray.delta.xy;
    return clamp(ivec2(floor(position_px)), ivec2(0), size_px - 1);
}

// Screen t of the point at a fraction of the segment's length in view space (1/distance is linear on screen).
real fraction_to_t(Ray ray, real fraction)
{
    if (orthographic != 0) return fraction;
    real end_depth = ray.origin.z + ray.delta.z;
    return fraction * ray.origin.z / (end_depth - fraction * ray.delta.z);
}

// Screen t of the point so many metres along the ray; > 1 beyond the end of the segment. Infinity is beyond every end, also of a ray without one.
real metres_to_t(Ray ray, real distance_m)
{
    real fraction = distance_m / ray.length_m;
    return isinf(distance_m) || fraction > real(1) ? real(2) : fraction_to_t(ray, fraction);
}

// ---- Strides
// Screen t of a stride, in pixels along the longer axis; a ray that is shorter makes one stride.
real stride_to_t(Ray ray, real stride_px)
{
    return stride_px / max(stride_px, max(abs(ray.delta.x), abs(ray.delta.y)));
}

// The same number for the same pixel, in [0, 1), unlike its neighbours'.
real random_of(ivec2 pixel)
{
    return real(pcg(pcg(uint(pixel.x)) + uint(pixel.y)) >> 8) / real(1 << 24);
}

// ---- Fetches
// Normal of a pixel in view space; the work counters count depths alone.
real3 fetch_normal(ivec2 pixel)
{
    return real3(imageLoad(normal_image, pixel).xyz);
}

// Of the two pixels of a texel, this one.
uint depth_bits(uvec2 pair, ivec2 pixel)
{
    return (pixel.x & 1) != 0 ? pair.y : pair.x;
}

// The cell of a level >= 1 that holds a pixel (pyramid_cell.glsl says what it knows), or at level 0 the two pixels of which it is one.
uvec2 load_pyramid(ivec2 pixel, int level)
{
    return imageLoad(depth_pyramid, cell_index(pixel, level)).xy;
}

// Reads two pixels: a walk is up to a third faster so on lavapipe (docs/performance.md).
real pixel_depth(ivec2 pixel)
{
    return real(uintBitsToFloat(depth_bits(load_pyramid(pixel, 0), pixel)));
}

real fetch_depth(ivec2 pixel)
{
    COUNT(depth_fetches);
    return pixel_depth(pixel);
}

// ---- Beams
#ifdef RAY_BEAMS
#ifdef REAL_IS_DOUBLE
layout(set = 0, binding = 12, scalar) readonly buffer Beams { real2 clear_stretches[]; };
real2 load_stretch(int stretch) { return clear_stretches[stretch]; }
#else
layout(set = 0, binding = 12, rg32f) uniform readonly imageBuffer Beams; // as texels: layout/packed_ray.glsl says why
real2 load_stretch(int stretch) { return imageLoad(Beams, stretch).xy; }
#endif
#ifdef COUNT_WORK
layout(set = 0, binding = 13, scalar) readonly buffer BeamWork { uint beam_fetches[]; };
#endif
#endif

// Two t between which no ray of this group touches anything (shaders/ray_beams.comp): stretch 0, the next one … Where there is none, or the
// technique's inputs do not name "ray_beams", it begins beyond every end.
real2 clear_stretch(int number)
{
#ifdef RAY_BEAMS
    if (number < BEAM_STRETCHES) return load_stretch(int(work_group()) * BEAM_STRETCHES + number);
#endif
    return real2(2);
}

// ---- The hit contract
// How far rounding may move the depth of a ray. Nothing in double precision, which is what float is held to.
real depth_rounding(real3 delta)
{
#ifdef REAL_IS_DOUBLE
    return real(0);
#else
    return abs(delta.z) * (1.0 / (1 << 24)); // what half of the last place of t = 1 moves it by
#endif
}

// Depths that the ray covers between two of its depths: x the farthest, y the nearest. Wider by what rounding may move them, so that
// rounding finds a hit that barely is none rather than lose one (docs/exactness.md).
real2 depth_interval(Ray ray, real z_a, real z_b)
{
    precise real2 interval = (z_a < z_b ? real2(z_a, z_b) : real2(z_b, z_a)) + real2(-1, 1) * ray.rounding;
    return interval;
}

bool interval_touches(real depth, real2 interval)
{
    return depth >= interval.x && reaches_slab_back(depth, interval.y);
}

// Direction in view space from the ray's origin to a position of some depth, not normalised.
real3 direction_to_vs(Ray ray, real2 position_px, real depth)
{
    return px_to_direction_vs(ray.origin, real3(position_px, depth));
}

real3 direction_vs(Ray ray)
{
    return px_to_direction_vs(ray.origin, ray.origin + ray.delta);
}

bool faces(Ray ray, ivec2 pixel)
{
    return facing_rule == 0 || dot(fetch_normal(pixel), direction_vs(ray)) < real(0);
}

// A surface that the ray touches is hit unless it faces away and that matters.
bool accepts(Ray ray, ivec2 pixel, bool touched, bool is_pixel)
{
    if (facing_rule == 0) return touched;
    bool accepted = !is_pixel || faces(ray, pixel);
    if (touched && !accepted) met_facing_away[current_ray] = true;
    return touched && accepted;
}

// Does the ray, whose depth covers the interval between z_a and z_b, hit the surface seen at this pixel?
bool touches_surface(Ray ray, ivec2 pixel, real z_a, real z_b)
{
    return accepts(ray, pixel, interval_touches(fetch_depth(pixel), depth_interval(ray, z_a, z_b)), true);
}

// What a cell of any level holds. Pixels and cells are read from one place: lanes of one group stand on different levels, and a branch would run
// both sides.
struct CellContent
{
    real  depth; // level 0
    uvec2 node;  // level >= 1
};

// The cell of a level that holds a pixel.
CellContent fetch_cell(ivec2 pixel, int level)
{
    bool leaf = level == 0;
    COUNT_IF(depth_fetches, leaf);
    COUNT_IF(pyramid_fetches, !leaf);
    uvec2 texel = load_pyramid(pixel, level);
    return CellContent(real(uintBitsToFloat(leaf ? depth_bits(texel, pixel) : 0u)), texel); // a cell's words may be no usable number
}

// The nearest front of that cell: at level 0 the depth of the pixel, above no pixel of the cell is nearer.
real fetch_front(ivec2 pixel, int level)
{
    CellContent content = fetch_cell(pixel, level);
    return level == 0 ? content.depth : real(uintBitsToFloat(content.node.x));
}

// May the ray touch a surface inside the cell that holds this pixel? At level 0 the answer is touches_surface()'s; above, no means no for all
// its pixels.
bool touches_cell(Ray ray, ivec2 pixel, int level, CellContent content, real z_a, real z_b)
{
    bool  leaf     = level == 0;
    real2 interval = depth_interval(ray, z_a, z_b);
    // Both answers, then a choice: a condition would become a branch, whose both sides run with more bookkeeping.
    bool in_front = content.depth >= interval.x, reached = reaches_slab_back(content.depth, interval.y);
    bool pixel_touched = in_front && reached, cell_touched = cell_may_touch(content.node, float(interval.x), float(interval.y));
    return accepts(ray, pixel, leaf ? pixel_touched : cell_touched, leaf);
}

// ---- Results
TraceResult hit_at(Ray ray, ivec2 pixel, real t, int steps)
{
    return TraceResult(TRACE_HIT, pixel, t, steps);
}

// A hit somewhere in [t_in, t_out]: the point where the ray first meets the slab.
TraceResult hit_between(Ray ray, ivec2 pixel, real t_in, real t_out, int steps)
{
    real depth = pixel_depth(pixel);
    real z_in  = depth_at(ray, t_in);
    real face  = z_in > depth ? depth : slab_back(depth);
    bool inside = z_in <= depth && reaches_slab_back(depth, z_in);
    precise real t_face = (face - ray.origin.z) / ray.delta.z;
    real t     = inside || ray.delta.z == real(0) ? t_in : clamp(t_face, t_in, t_out);
    return TraceResult(TRACE_HIT, pixel, t, steps);
}

TraceResult miss(Ray ray, int steps)
{
    return TraceResult(met_facing_away[current_ray] ? TRACE_FACING_AWAY : ray.end_status, ivec2(0), real(0), steps);
}

TraceResult out_of_steps(int steps)
{
    return TraceResult(TRACE_OUT_OF_STEPS, ivec2(0), real(0), steps);
}

// ---- Walking by borders. `crossing` is the t of one: a number, or a count of exact steps.
#ifdef EXACT_ARITHMETIC
#include "api/grid_exact.glsl"
#else
#include "api/grid_float.glsl"
#endif

// Where the ray leaves the cell whose borders it crosses at t_border. A select: cheaper than min() on some devices, and no number is NaN.
crossing exit_t(Grid grid, crossing2 t_border)
{
    crossing t = t_border.x < t_border.y ? t_border.x : t_border.y;
    return t < grid.t_end ? t : grid.t_end;
}

// The neighbour cell behind the border, or the corner, that is crossed at t.
ivec2 cross_borders(Grid grid, ivec2 cell, crossing2 t_border, crossing t)
{
    return cell + ivec2(lessThanEqual(t_border, crossing2(t))) * (2 * grid.forward - 1);
}

// ---- Cells of any size, for a ray that runs forward on both axes (run_forward). A cell is named by its exit corner: the borders where the
// ray leaves it, x and y multiples of its size in pixels.
// The corner of the neighbour behind the border, or the corner, that is crossed at t.
ivec2 next_corner(ivec2 corner, int size, crossing2 t_border, crossing t)
{
    return mix(corner, corner + size, lessThanEqual(t_border, crossing2(t)));
}

// The corner of the quarter of the cell that holds the ray at t.
ivec2 child_corner(Ray ray, Grid grid, ivec2 corner, int size, crossing t)
{
    ivec2 middle = corner - (size >> 1);
    return mix(middle, corner, lessThanEqual(border_t(ray, grid, middle), crossing2(t)));
}

#ifndef EXACT_ARITHMETIC
// Where the ray enters and leaves a pixel that it crosses.
real2 span_in_pixel(Ray ray, Grid grid, ivec2 pixel)
{
    real2 t_entry = border_t(ray, grid, pixel + 1 - grid.forward);
    real  t_in    = max(real(0), max(t_entry.x, t_entry.y));
    return real2(t_in, max(t_in, exit_t(grid, border_t(ray, grid, pixel + grid.forward))));
}
#endif
