// A pixel as a plane with a small tolerance behind it, and what lies between the plane and the next surface where that is the far side of a solid
// (solid.glsl: nothing; solid.surface_solid.glsl, solid.solid_endless.glsl). shaders/surfaces/README.md says what each function answers.
#include "surfaces/plane/stored.glsl"
#include "surfaces/plane/solid.glsl"

struct PixelSurface
{
    real start, rate; // the ray's height above the plane is start + t * rate
    real back;        // the height where the tolerance, or the slab of a pixel without a plane, ends
    real solid;       // the depth where the solid ends; nearer than everything without one
};

PixelSurface surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words)
{
    real  depth    = real(depth_in(words, pixel));
    vec2  stored   = unpack_gradient(words.y);
    bool  usable   = has_plane(stored);
    real2 gradient = usable ? real2(stored) : real2(0);
    real2 from_centre = ray.origin.xy - (real2(pixel) + real(0.5));
    precise real start = (ray.origin.z - depth) - (gradient.x * from_centre.x + gradient.y * from_centre.y);
    precise real rate  = ray.delta.z - (gradient.x * ray.delta.x + gradient.y * ray.delta.y);
    return PixelSurface(start, rate, usable ? -plane_tolerance(depth) : slab_back(depth) - depth, real(load_solid(pixel, layer)));
}

// One sample sees no crossing: it needs a thickness, the run's.
PixelSurface sampled_surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words)
{
    PixelSurface surface = surface_at(ray, pixel, layer, words);
    real         depth   = real(depth_in(words, pixel));
    surface.back         = min(surface.back, slab_back(depth) - depth);
    return surface;
}

real height_at(PixelSurface surface, real t)
{
    precise real height = surface.start + t * surface.rate;
    return height;
}

bool meets(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real a = height_at(surface, t_in), b = height_at(surface, t_out), z_a = depth_at(ray, t_in), z_b = depth_at(ray, t_out);
    real low = a < b ? a : b, high = a < b ? b : a;
    bool in_solid = has_solids && high < surface.back && (z_a > z_b ? z_a : z_b) >= surface.solid;
    return low <= real(0) && high >= surface.back || in_solid;
}

// It comes from below.
bool from_behind(Ray ray, PixelSurface surface, real t_in) { return height_at(surface, t_in) < surface.back; }

real contact_t(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real height = height_at(surface, t_in);
    real face   = height > real(0) ? real(0) : surface.back;
    precise real t_face = (face - surface.start) / surface.rate;
    real t = height <= real(0) && height >= surface.back || surface.rate == real(0) ? t_in : clamp(t_face, t_in, t_out);
    if (!(height < surface.back)) return t;

    // Only a back that the ray reaches counts: one that it leaves lies before t_in.
    if (height_at(surface, t_out) < surface.back) t = t_out;
    precise real t_solid = (surface.solid - ray.origin.z) / ray.delta.z;
    if (depth_at(ray, t_in) >= surface.solid) return t_in;
    return depth_at(ray, t_out) >= surface.solid ? clamp(min(t, t_solid), t_in, t_out) : t;
}
