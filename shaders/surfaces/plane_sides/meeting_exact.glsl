// meeting.glsl for arithmetic = exact.
// As scaled_depth(): heights times `whole`.
double scaled_height(Grid grid, real start, real rate, int64_t t)
{
    precise double height = double(t) * double(rate) - (-double(start) * double(grid.whole));
    return height;
}

bool meets(Ray ray, Grid grid, PixelSurface surface, int64_t t_in, int64_t t_out)
{
    double a = scaled_height(grid, surface.start, surface.rate, t_in), b = scaled_height(grid, surface.start, surface.rate, t_out);
    // Scaled back: the product of two scaled heights would be as large as the fourth power of the image.
    double far_a = scaled_height(grid, surface.far_start, surface.far_rate, t_in) / double(grid.whole);
    double far_b = scaled_height(grid, surface.far_start, surface.far_rate, t_out) / double(grid.whole);
    if (a > 0.0lf) return b <= 0.0lf && !surface.far_side && (!surface.solid || far_b * a >= far_a * b);
    if (b > 0.0lf) return !surface.solid;
    return surface.solid && far_a >= 0.0lf && far_b >= 0.0lf;
}
