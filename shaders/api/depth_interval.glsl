// The depths that a ray covers, for a hit test on depths alone.

// Between two of its depths: x the farthest, y the nearest. Wider by what rounding may move them: a near tie becomes a hit, and no hit is lost
// (docs/explanation/exactness.md).
real2 depth_interval(Ray ray, real z_a, real z_b)
{
    precise real2 interval = (z_a < z_b ? real2(z_a, z_b) : real2(z_b, z_a)) + real2(-1, 1) * ray.rounding;
    return interval;
}
