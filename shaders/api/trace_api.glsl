// What a technique sees: a ray that is ready, counted fetches, the hit contract, and results that say why they stopped.
// A technique defines    TraceResult trace(Ray ray)
//
// One rule for loops: a loop ends in its condition, at the top; never by break or return in its body.
#ifdef EXACT_ARITHMETIC
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif
#include "api/view.glsl"
#include "api/slab.glsl"
#include "layout/load_cell.glsl"
#include "layout/normal_image.glsl"
#include "trace/work_counters.glsl"
#include "trace/visits.glsl"

layout(constant_id = CONSTANT_BEHIND) const int behind_rule = 0; // BEHIND_*

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
    int   status; // TRACE_*, of a layer behind the first as status_to_number() says
    ivec2 pixel;  // the pixel that was met; undefined unless TRACE_HIT or TRACE_STOPPED
    real  t;      // where the ray first meets what that pixel holds; undefined likewise
    int   steps;  // loop iterations
};

// ---- The ray
// Its depth at t; larger is nearer. Not mix(): that is not monotone in t.
real depth_at(Ray ray, real t)
{
    precise real depth = ray.origin.z + t * ray.delta.z;
    return depth;
}

// The pixel that contains it at t.
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

// Screen t of the point so many metres along the ray; above 1 beyond the end of the segment. Infinity is beyond every end.
real metres_to_t(Ray ray, real distance_m)
{
    real fraction = distance_m / ray.length_m;
    return isinf(distance_m) || fraction > real(1) ? real(2) : fraction_to_t(ray, fraction);
}

// Screen t of a stride, in pixels along the longer axis; a shorter ray takes one stride.
real stride_to_t(Ray ray, real stride_px) { return stride_px / max(stride_px, max(abs(ray.delta.x), abs(ray.delta.y))); }

// Direction in view space from the ray's origin to a position of some depth, not normalised.
real3 direction_to_vs(Ray ray, real2 position_px, real depth)
{
    return px_to_direction_vs(ray.origin, real3(position_px, depth));
}

// Direction of the ray in view space, not normalised.
real3 direction_vs(Ray ray) { return px_to_direction_vs(ray.origin, ray.origin + ray.delta); }

// ---- Fetches
// Normal of a pixel in view space; not counted.
real3 fetch_normal(ivec2 pixel) { return real3(imageLoad(normal_image, pixel).xyz); }

// What is stored of a pixel, for surface_at(); counted.
uvec2 fetch_pixel(ivec2 pixel)
{
    count_depth_fetch();
    record_visit(pixel, 0);
    return load_cell(pixel, 0);
}

// Depth of a pixel, BACKGROUND_DEPTH where there is nothing; counted.
real fetch_depth(ivec2 pixel) { return real(depth_in(fetch_pixel(pixel), pixel)); }

// ---- The hit contract (docs/reference/hit_contract.md)
// How far rounding may move the depth of a ray. Nothing in double precision, which is what float is held to.
real depth_rounding(real3 delta)
{
#ifdef REAL_IS_DOUBLE
    return real(0);
#else
    return abs(delta.z) * (1.0 / (1 << 24)); // what half of the last place of t = 1 moves it by
#endif
}

// Depths that the ray covers between two of its depths: x the farthest, y the nearest. Wider by what rounding may move them: a near tie becomes a hit,
// and no hit is lost (docs/explanation/exactness.md).
real2 depth_interval(Ray ray, real z_a, real z_b)
{
    precise real2 interval = (z_a < z_b ? real2(z_a, z_b) : real2(z_b, z_a)) + real2(-1, 1) * ray.rounding;
    return interval;
}

// Does an interval of depths meet the slab of this depth?
bool interval_touches(real depth, real2 interval)
{
    bool in_front = slab_front(depth) >= interval.x, reached = reaches_slab_back(depth, interval.y); // both, then a choice: cheaper than a branch
    return in_front && reached;
}

#if LAYERS > 1
#include "trace/fetch_layers.glsl"
#else
real3 fetch_normal(ivec2 pixel, int layer) { return fetch_normal(pixel); }
#endif

// What a pixel holds in a layer, by the run's surface model (shaders/surfaces/README.md):
//   PixelSurface surface_at(Ray, ivec2 pixel, int layer, uvec2 words)          words: fetch_pixel()
//   PixelSurface sampled_surface_at(Ray, ivec2 pixel, int layer, uvec2 words)  for one sample instead of an interval
//   bool meets(Ray, PixelSurface, real t_in, real t_out)        does the ray meet it between the two
//   bool from_behind(Ray, PixelSurface, real t_in)              from the side that the frame does not show, if it meets it
//   real contact_t(Ray, PixelSurface, real t_in, real t_out)    where, if it meets it
#include "surface/meeting.glsl"

// ---- Walking by borders. `crossing` is the t of one: a real, or a count of exact steps (arithmetic = exact).
#ifdef EXACT_ARITHMETIC
#include "api/grid_exact.glsl"
#include "surface/meeting_exact.glsl"
#else
#include "api/grid_float.glsl"
bool meets(Ray ray, Grid grid, PixelSurface surface, real t_in, real t_out) { return meets(ray, surface, t_in, t_out); }
#endif

// Does a ray that meets a pixel end there? Not where it comes from behind and may pass.
bool ends_at(Ray ray, PixelSurface surface, bool met, real t_in)
{
    if (behind_rule != BEHIND_PASS || !met) return met;
    bool passes = from_behind(ray, surface, t_in);
    if (passes) note_facing_away();
    return !passes;
}

// What a ray meets in a pixel, or nothing: the hit test returns it, and the result is made of it.
struct Contact
{
    bool  found;       // the ray ends here, by a hit or by being stopped
    ivec2 pixel;
    int   layer;       // of several the one that the ray meets first
    uvec2 words;       // what is stored of that layer
    real  t_in, t_out; // the interval that was tested
    bool  sampled;     // it was a single sample
};

// Nothing, before the first test.
Contact no_contact()
{
    Contact none;
    none.found = false;
    return none;
}

// What the pixel holds in the layer that was met.
PixelSurface surface_of(Ray ray, Contact contact)
{
    if (contact.sampled) return sampled_surface_at(ray, contact.pixel, contact.layer, contact.words);
    return surface_at(ray, contact.pixel, contact.layer, contact.words);
}

#if LAYERS > 1
#include "trace/layers.glsl"
#else
Contact first_of_layers(Ray ray, Contact front) { return front; }
Contact first_of_layers(Ray ray, Grid grid, Contact front, crossing t_in, crossing t_out) { return front; }
#endif

Contact test_interval(Ray ray, ivec2 pixel, real t_in, real t_out, bool sampled)
{
    note_interval(t_in, t_out);
    Contact      contact = Contact(false, pixel, 0, fetch_pixel(pixel), t_in, t_out, sampled);
    PixelSurface surface = surface_of(ray, contact);
    contact.found        = ends_at(ray, surface, meets(ray, surface, t_in, t_out), t_in);
    return first_of_layers(ray, contact);
}

// The hit test: where does the ray end in this pixel, between two t?
Contact test_pixel(Ray ray, ivec2 pixel, real t_in, real t_out) { return test_interval(ray, pixel, t_in, t_out, false); }

// The same by one sample, at t. There a plane has the thickness of the run.
Contact test_sample(Ray ray, ivec2 pixel, real t) { return test_interval(ray, pixel, t, t, true); }

// The same between two crossings.
Contact test_pixel(Ray ray, Grid grid, ivec2 pixel, crossing t_in, crossing t_out)
{
    Contact      contact = Contact(false, pixel, 0, fetch_pixel(pixel), crossing_to_t(grid, t_in), crossing_to_t(grid, t_out), false);
    PixelSurface surface = surface_of(ray, contact);
    contact.found        = ends_at(ray, surface, meets(ray, grid, surface, t_in, t_out), contact.t_in);
    return first_of_layers(ray, grid, contact, t_in, t_out);
}

// Where the ray leaves the cell whose borders it crosses at t_border, or ends. A select, not min(): no number is NaN.
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

// ---- Results
// The ray ends at what it met, at this t.
TraceResult hit_at(Ray ray, Contact contact, real t, int steps)
{
    bool stopped = behind_rule == BEHIND_STOP && from_behind(ray, surface_of(ray, contact), contact.t_in);
    return TraceResult(status_to_number(stopped ? TRACE_STOPPED : TRACE_HIT, contact.layer), contact.pixel, t, steps);
}

// The same where it first meets it.
TraceResult hit(Ray ray, Contact contact, int steps)
{
    return hit_at(ray, contact, contact_t(ray, surface_of(ray, contact), contact.t_in, contact.t_out), steps);
}

// The same for a loop that has pixel and interval of the contact anyway: without those in the contact, it carries less.
TraceResult hit_between(Ray ray, Contact contact, ivec2 pixel, real t_in, real t_out, int steps)
{
    contact.pixel = pixel;
    contact.t_in  = t_in;
    contact.t_out = t_out;
    return hit(ray, contact, steps);
}

// Nothing was hit: the ray ends as its segment says, or as one that met something from behind and passed.
TraceResult miss(Ray ray, int steps)
{
    return TraceResult(met_facing_away() ? TRACE_FACING_AWAY : ray.end_status, ivec2(0), real(0), steps);
}

// The step budget is exhausted. That is never a hit.
TraceResult out_of_steps(int steps)
{
    return TraceResult(TRACE_OUT_OF_STEPS, ivec2(0), real(0), steps);
}
