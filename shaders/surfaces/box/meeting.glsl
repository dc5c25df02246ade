// A pixel as a box: a level front, and a slab behind it. `box_two_sided` (SURFACE_TWO_SIDED) reaches as far before its depth as behind it;
// `box_infinite` has a slab without an end. shaders/surfaces/README.md says what each function answers.
struct PixelSurface
{
    real  depth;
    ivec2 pixel;
};

PixelSurface surface_at(Ray ray, ivec2 pixel, uvec2 words) { return PixelSurface(real(depth_in(words, pixel)), pixel); }

PixelSurface sampled_surface_at(Ray ray, ivec2 pixel, uvec2 words) { return surface_at(ray, pixel, words); }

bool meets(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    return interval_touches(surface.depth, depth_interval(ray, depth_at(ray, t_in), depth_at(ray, t_out)));
}

// It meets a side that faces away.
bool from_behind(Ray ray, PixelSurface surface, real t_in)
{
    return !(dot(fetch_normal(surface.pixel), direction_vs(ray)) < real(0));
}

real contact_t(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real z_in  = depth_at(ray, t_in), front = slab_front(surface.depth);
    real face  = z_in > front ? front : slab_back(surface.depth);
    bool inside = z_in <= front && reaches_slab_back(surface.depth, z_in);
    precise real t_face = (face - ray.origin.z) / ray.delta.z;
    return inside || ray.delta.z == real(0) ? t_in : clamp(t_face, t_in, t_out);
}

#ifdef EXACT_ARITHMETIC
// Depths are compared without a division, times `whole` and counted from the ray's origin: what is equal stays equal in both products.
bool meets(Ray ray, Grid grid, PixelSurface surface, int64_t t_in, int64_t t_out)
{
    double         z_a = scaled_depth(ray, t_in), z_b = scaled_depth(ray, t_out);
    double         origin = double(ray.origin.z), whole = double(grid.whole);
    precise double low   = (slab_back_of(double(surface.depth)) - origin) * whole;
    precise double high  = (slab_front_of(double(surface.depth)) - origin) * whole;
    return high >= min(z_a, z_b) && low <= max(z_a, z_b);
}
#endif
