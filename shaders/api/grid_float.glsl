// Borders between pixels, in closed form: the same number at every level of the pyramid, monotone along the ray.
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

// Depths that the ray covers between two crossings, rounded outward: x the farthest, y the nearest.
vec2 covered_depths(Ray ray, Grid grid, real t_in, real t_out)
{
    return vec2(depth_interval(ray, depth_at(ray, t_in), depth_at(ray, t_out)));
}

// Where the ray enters and leaves a pixel that it crosses.
real2 span_in_pixel(Ray ray, Grid grid, ivec2 pixel)
{
    real2 t_entry = border_t(ray, grid, pixel + 1 - grid.forward);
    real  t_in    = max(real(0), max(t_entry.x, t_entry.y));
    real2 t_exit  = border_t(ray, grid, pixel + grid.forward);
    return real2(t_in, max(t_in, min(min(t_exit.x, t_exit.y), grid.t_end)));
}
