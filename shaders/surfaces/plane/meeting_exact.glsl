// meeting.glsl for arithmetic = exact.
// As scaled_depth(): heights times `whole`.
bool meets(Ray ray, Grid grid, PixelSurface surface, int64_t t_in, int64_t t_out)
{
    double         whole = double(grid.whole);
    precise double a = double(t_in) * double(surface.rate), b = double(t_out) * double(surface.rate);
    precise double front = -double(surface.start) * whole, back = (double(surface.back) - double(surface.start)) * whole;
    bool           met = min(a, b) <= front && max(a, b) >= back;
    double         z_a = scaled_depth(ray, t_in), z_b = scaled_depth(ray, t_out);
    precise double solid = (double(surface.solid) - double(ray.origin.z)) * whole;
    met = met || (max(a, b) < back && max(z_a, z_b) >= solid);
    return met;
}
