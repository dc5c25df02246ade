// What a technique sees: a ray that is ready, counted fetches, the hit contract, and results that say why they stopped.
// A technique defines    TraceResult trace(Ray ray)
// and includes what more it needs: api/test_pixel.glsl, api/sampling.glsl, api/directions.glsl …
//
// One rule for loops: a loop ends in its condition, at the top; never by break or return in its body.
#include "api/camera.glsl"
#include "api/slab.glsl"
#include "layout/load_cell.glsl"
#include "trace/facing_away.glsl"
#include "trace/work.glsl"
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

// The ray's depth at t; larger is nearer. Not mix(): that is not monotone in t.
real depth_at(Ray ray, real t)
{
    precise real depth = ray.origin.z + t * ray.delta.z;
    return depth;
}

// ---- The hit contract (docs/reference/hit_contract.md)
// What a pixel holds in a layer, by the run's surface model (shaders/surfaces/README.md):
//   PixelSurface surface_at(Ray, ivec2 pixel, int layer, uvec2 words)          words: what is stored of the pixel
//   PixelSurface sampled_surface_at(Ray, ivec2 pixel, int layer, uvec2 words)  for one sample instead of an interval
//   bool meets(Ray, PixelSurface, real t_in, real t_out)        does the ray meet it between the two
//   bool from_behind(Ray, PixelSurface, real t_in)              from the side that the frame does not show, if it meets it
//   real contact_t(Ray, PixelSurface, real t_in, real t_out)    where, if it meets it
#include "surface/meeting.glsl"

// Walking by borders. `crossing` is the t of one: a real, or a count of exact steps (arithmetic = exact).
#include "api/grid.glsl"

// Does a ray that meets a pixel end there? Not where it comes from behind and may pass.
bool ends_at(Ray ray, PixelSurface surface, bool met, real t_in)
{
    if (behind_rule != BEHIND_PASS || !met) return met;
    bool passes = from_behind(ray, surface, t_in);
    if (passes) met_facing_away = true;
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

#include "trace/layers.glsl"

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
    return hit(ray, Contact(true, pixel, contact.layer, contact.words, t_in, t_out, contact.sampled), steps);
}

// Nothing was hit: the ray ends as its segment says, or as one that met something from behind and passed.
TraceResult miss(Ray ray, int steps)
{
    return TraceResult(met_facing_away ? TRACE_FACING_AWAY : ray.end_status, ivec2(0), real(0), steps);
}

// The step budget is exhausted. That is never a hit.
TraceResult out_of_steps(int steps)
{
    return TraceResult(TRACE_OUT_OF_STEPS, ivec2(0), real(0), steps);
}
