// A node of the quadtree, one for each cell of each level >= 1. Its plane is linear on screen and 0 at the centre of its cell. A height is a depth less
// the plane's. Where a pixel of the cell has a surface, the heights of its slab, at every place of the pixel, lie between low and high, and in those of
// the 32 bins from high down to low that are set.
struct Node
{
    vec2  gradient; // of the plane, a pixel
    float low, high;
    uint  bins; // bit 0: the bin below high. None: no pixel has a surface
};

const float no_end     = 1e30; // beyond every height
const Node  empty_node = Node(vec2(0), no_end, -no_end, 0u);

// How far rounding moves a ray's position from the pixel that it is in, at the largest image; a depth, as a share of the numbers that enter; and a
// place among the bins: each many times more than it can.
const float rounding_px = 1.0 / 64, rounding_share = 1.0 / (1 << 18), rounding_bins = 1.0 / 256;

uvec4 pack_node(Node node)
{
    uvec2 gradient = floatBitsToUint(node.gradient);
    return uvec4((gradient.x & 0xFFFF0000u) | gradient.y >> 16, floatBitsToUint(vec2(node.low, node.high)), node.bins);
}

Node unpack_node(uvec4 words)
{
    return Node(uintBitsToFloat(uvec2(words.x & 0xFFFF0000u, words.x << 16)), uintBitsToFloat(words.y), uintBitsToFloat(words.z), words.w);
}

// To the nearest gradient that a packed node can hold.
vec2 round_gradient(vec2 gradient)
{
    return uintBitsToFloat((floatBitsToUint(gradient) + 0x8000u) & 0xFFFF0000u);
}

float bin_height(Node node)
{
    return max(node.high - node.low, 1e-30) / 32;
}

// 0 <= first <= last <= 31
uint bins_between(int first, int last)
{
    return (~0u << first) & ~(~1u << last);
}

// The bins that an interval of heights meets.
uint bins_of(Node node, float low, float high)
{
    float bins_per_height = 1 / bin_height(node);
    vec2  place = vec2(node.high - high, node.high - low) * bins_per_height + vec2(-rounding_bins, rounding_bins);
    ivec2 ends  = ivec2(clamp(place, 0.0, 31.0));
    return place.y < 0.0 || place.x > 32.0 ? 0u : bins_between(ends.x, ends.y);
}
