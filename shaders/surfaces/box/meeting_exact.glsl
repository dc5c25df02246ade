// meeting.glsl for arithmetic = exact.
// Depths are compared without a division, times `whole` and counted from the ray's origin: what is equal stays equal in both products.
bool meets(Ray ray, Grid grid, PixelSurface surface, int64_t t_in, int64_t t_out)
{
    double         z_a = scaled_depth(ray, t_in), z_b = scaled_depth(ray, t_out);
    double         origin = double(ray.origin.z), whole = double(grid.whole);
    precise double low   = (slab_back_of(double(surface.depth)) - origin) * whole;
    precise double high  = (slab_front_of(double(surface.depth)) - origin) * whole;
    return high >= min(z_a, z_b) && low <= max(z_a, z_b);
}
