// A pixel as a box: a level front, and a slab behind it. `box_two_sided` (SURFACE_TWO_SIDED) reaches as far before its depth as behind it;
// `box_infinite` has a slab without an end. shaders/surfaces/README.md says what each function answers.
#include "api/box.glsl"
#include "api/depth_interval.glsl"
#include "api/directions.glsl"

struct PixelSurface
{
    real  depth;
    ivec2 pixel;
    int   layer;
};

PixelSurface surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words) { return PixelSurface(real(depth_in(words, pixel)), pixel, layer); }

PixelSurface sampled_surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words) { return surface_at(ray, pixel, layer, words); }

bool meets(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    return interval_touches(surface.depth, depth_interval(ray, depth_at(ray, t_in), depth_at(ray, t_out)));
}

// It meets a side that faces away.
bool from_behind(Ray ray, PixelSurface surface, real t_in)
{
    return !(dot(fetch_normal(surface.pixel, surface.layer), direction_vs(ray)) < real(0));
}

real contact_t(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real z_in  = depth_at(ray, t_in), front = slab_front(surface.depth);
    real face  = z_in > front ? front : slab_back(surface.depth);
    bool inside = z_in <= front && reaches_slab_back(surface.depth, z_in);
    precise real t_face = (face - ray.origin.z) / ray.delta.z;
    return inside || ray.delta.z == real(0) ? t_in : clamp(t_face, t_in, t_out);
}
