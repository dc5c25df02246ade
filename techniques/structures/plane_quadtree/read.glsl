// How techniques read the plane quadtree. A node is named by its level and a pixel of its cell; level 0 is the pixels themselves.
#include "node.glsl"

// The coarsest level that is there.
int quadtree_top()
{
    return min(plane_quadtree_top_level, pyramid_levels());
}

// The node of a level >= 1 whose cell holds a pixel; counted.
Node fetch_node(ivec2 pixel, int level)
{
    count_fetch(STRUCTURE_plane_quadtree);
    record_visit(pixel, level);
    return unpack_node(load_nodes(level_cell_index(pixel, level)));
}

// The ray's height above the plane of a node, at t; linear in t. first: the first pixel of its cell.
real height_at(Ray ray, Node node, ivec2 first, int level, real t)
{
    real2 from_centre = ray.origin.xy - (real2(first) + real(1 << level) / 2) + t * ray.delta.xy;
    return depth_at(ray, t) - dot(real2(node.gradient), from_centre);
}

// May the ray touch a surface inside a cell of level >= 1 between two crossings? No means no for all its pixels. t_touch: before that, at or behind t_in
// and before t_out, it touches none.
bool touches_node(Ray ray, Grid grid, ivec2 first, int level, crossing t_in, crossing t_out, out crossing t_touch)
{
    t_touch    = t_in;
    Node node  = fetch_node(first, level);
    real slack = (abs(ray.origin.z) + abs(ray.delta.z)) * real(rounding_share);
    real from = height_at(ray, node, first, level, crossing_to_t(grid, t_in)), to = height_at(ray, node, first, level, crossing_to_t(grid, t_out));
    uint bins = node.bins & bins_of(node, float(min(from, to) - slack), float(max(from, to) + slack));
    if (bins == 0u) return false;
    // It enters the first bin of these from above or from below.
    real height = real(bin_height(node));
    real high   = real(node.high) - (real(findLSB(bins)) - real(rounding_bins)) * height + slack;
    real low    = real(node.high) - (real(findMSB(bins) + 1) + real(rounding_bins)) * height - slack;
    real share  = from > high ? (from - high) / (from - to) : from < low ? (low - from) / (to - from) : real(0);
    crossing t  = t_in + crossing(real(t_out - t_in) * min(share, real(1)));
    if (t > t_in && t < t_out) t_touch = t;
    return true;
}
