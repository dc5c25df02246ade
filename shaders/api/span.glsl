// Where a ray enters and leaves a pixel that it crosses. Not for arithmetic = exact.
real2 span_in_pixel(Ray ray, Grid grid, ivec2 pixel)
{
    real2 t_entry = border_t(ray, grid, pixel + 1 - grid.forward);
    real  t_in    = max(real(0), max(t_entry.x, t_entry.y));
    real2 t_exit  = border_t(ray, grid, pixel + grid.forward);
    return real2(t_in, max(t_in, min(min(t_exit.x, t_exit.y), grid.t_end)));
}
