// Does a ray meet the slab of a depth sample, level across its pixel?
#include "api/slab.glsl"
#include "api/slab_front.glsl"

// Does the depth interval that ends at z_near (its nearest depth) reach the slab's back? Multiplied out: a division is not correctly
// rounded on every device, and it is slower.
bool reaches_slab_back(real depth, real z_near)
{
    precise real left  = z_near + (z_near * depth) * real(slab_slope);
    precise real right = depth * real(slab_scale) - real(slab_shift);
    return left >= right;
}

// Does an interval of depths meet the slab of this depth?
bool interval_touches(real depth, real2 interval)
{
    bool in_front = slab_front(depth) >= interval.x, reached = reaches_slab_back(depth, interval.y); // both, then a choice: cheaper than a branch
    return in_front && reached;
}
