// covered_depths.glsl for arithmetic = exact: rounded outward by more than all roundings of a hit test.
vec2 covered_depths(Ray ray, Grid grid, int64_t t_in, int64_t t_out)
{
    double z_a = scaled_depth(ray, t_in), z_b = scaled_depth(ray, t_out);
    double origin = double(ray.origin.z), whole = double(grid.whole);
    double slack  = 1e-13LF * (abs(origin) + abs(double(ray.delta.z)));
    return vec2(float(origin + min(z_a, z_b) / whole - slack), float(origin + max(z_a, z_b) / whole + slack));
}
