// Borders between pixels, in closed form: the same number at every level of the pyramid, monotone along the ray. grid.exact_arithmetic.glsl has the same in
// whole numbers.
#define crossing real
#define crossing2 real2

struct Grid
{
    real2 inverse_delta; // finite: a component that is zero crosses nothing
    ivec2 forward;       // 1 where the ray runs toward larger coordinates, else 0
    real  t_end;         // 1, or where rounding lets the ray cross the image border a little before
};

// t at which the ray crosses the borders x = border.x and y = border.y.
real2 border_t(Ray ray, Grid grid, ivec2 border)
{
    precise real2 t = (real2(border) - ray.origin.xy) * grid.inverse_delta;
    return t;
}

real crossing_to_t(Grid grid, real t) { return t; }

Grid make_grid(Ray ray)
{
    const real tiny = real(1e-20);
    bvec2      flat_axis = lessThan(abs(ray.delta.xy), real2(tiny));
    Grid       grid;
    grid.inverse_delta = real2(flat_axis.x ? real(1) / tiny : real(1) / ray.delta.x, flat_axis.y ? real(1) / tiny : real(1) / ray.delta.y);
    grid.forward       = ivec2(flat_axis.x || ray.delta.x > real(0), flat_axis.y || ray.delta.y > real(0));
    real2 t_image      = border_t(ray, grid, grid.forward * size_px);
    grid.t_end         = min(real(1), min(t_image.x, t_image.y));
    return grid;
}

bool meets(Ray ray, Grid grid, PixelSurface surface, real t_in, real t_out) { return meets(ray, surface, t_in, t_out); }
