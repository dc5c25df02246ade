#include "surfaces/plane/stored.glsl"

struct PixelSurface
{
    real start, rate; // the ray's height above the plane is start + t * rate
    real back;        // the height where the slab ends
};

PixelSurface surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words)
{
    real  depth       = real(depth_in(words, pixel));
    vec2  stored      = unpack_gradient(words.y);
    real2 gradient    = has_plane(stored) ? real2(stored) : real2(0);
    real2 from_centre = ray.origin.xy - (real2(pixel) + real(0.5));
    precise real start = (ray.origin.z - depth) - (gradient.x * from_centre.x + gradient.y * from_centre.y);
    precise real rate  = ray.delta.z - (gradient.x * ray.delta.x + gradient.y * ray.delta.y);
    return PixelSurface(start, rate, slab_back(depth) - depth);
}

PixelSurface sampled_surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words) { return surface_at(ray, pixel, layer, words); }

real height_at(PixelSurface surface, real t)
{
    precise real height = surface.start + t * surface.rate;
    return height;
}

bool meets(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real a = height_at(surface, t_in), b = height_at(surface, t_out);
    return min(a, b) <= real(0) && max(a, b) >= surface.back;
}

bool from_behind(Ray ray, PixelSurface surface, real t_in) { return height_at(surface, t_in) < surface.back; }

real contact_t(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real height = height_at(surface, t_in);
    real face   = height > real(0) ? real(0) : surface.back;
    bool inside = height <= real(0) && height >= surface.back;
    precise real t_face = (face - surface.start) / surface.rate;
    return inside || surface.rate == real(0) ? t_in : clamp(t_face, t_in, t_out);
}
