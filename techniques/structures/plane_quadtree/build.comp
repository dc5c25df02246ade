// A level of the plane quadtree from the level below. A pixel counts as a node of level 0: a level plane, and the band from its slab's back to its front.
#include "api/view.glsl"
#include "api/slab.glsl"
#include "api/held.glsl"
#include "structure/parameters"
#include "structure/buffers"
#include "node.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { int level; };

// What the pixel holds in a layer. What reaches behind depth 0 has no end: no ray passes behind it.
Node node_of_pixel(ivec2 pixel, int layer, uvec2 words)
{
    float depth = depth_in(words, pixel);
    if (!(depth > 0.0)) return empty_node;
    vec2 held = held_depths(pixel, layer, depth, words.y);
    return Node(vec2(0), held.y > 0.0 ? held.y : -no_end, min(held.x, no_end), ~0u);
}

// A part of the cell: of level 1 and 2 a pixel in a layer, of those above a quarter, which is a node of the level below.
Node load_part(ivec2 pixel, int part_level, int layer)
{
    if (any(greaterThanEqual(pixel, size_px))) return empty_node;
#if LAYERS > 1
    if (layer > 0) return node_of_pixel(pixel, layer, load_layer(pixel, layer));
#endif
    if (part_level == 0) return node_of_pixel(pixel, 0, load_cell(pixel, 0));
    return unpack_node(load_nodes(level_cell_index(pixel, part_level)));
}

// Parts lie layer by layer, as many a layer as there are places.
int   part_level = level <= 2 ? 0 : level - 1, across = 1 << (level - part_level), places = across * across;
int   parts_count = places * (part_level == 0 ? LAYERS : 1);
float part_px    = float(1 << part_level);
Node  parts[16 * LAYERS];

ivec2 place_of(int i) { return ivec2(i & (across - 1), i / across & (across - 1)); }

// From the centre of the cell to that of a part.
vec2 offset_px(int i) { return part_px * (vec2(place_of(i)) - float(across - 1) / 2); }

// How much more a height of a part may be above a plane of this gradient, at some place of its pixels, and how much less: x the least, y the most.
vec2 change_of_height(int i, vec2 gradient)
{
    float shift    = -dot(gradient, offset_px(i));
    float spread   = dot(abs(parts[i].gradient - gradient), vec2(part_px / 2 + rounding_px));
    float rounding = (dot(abs(parts[i].gradient) + abs(gradient), vec2(across * part_px)) + abs(parts[i].high)) * rounding_share;
    return vec2(shift - spread - rounding, shift + spread + rounding);
}

// The node with a plane of this gradient.
Node node_around(vec2 gradient)
{
    Node node     = empty_node;
    node.gradient = gradient;
    for (int i = 0; i < parts_count; ++i)
    {
        vec2 change = change_of_height(i, gradient);
        bool counts = parts[i].bins != 0u;
        node.low  = counts ? min(node.low, parts[i].low + change.x) : node.low;
        node.high = counts ? max(node.high, parts[i].high + change.y) : node.high;
    }
    for (int i = 0; i < parts_count; ++i)
    {
        vec2  change = change_of_height(i, gradient);
        float height = bin_height(parts[i]);
        uint  rest   = parts[i].bins; // run by run of bins that are set
        while (rest != 0u)
        {
            int  first = findLSB(rest), end = findLSB(~(rest | bins_between(0, first)));
            if (end < 0) end = 32;
            float low = end == 32 ? parts[i].low : parts[i].high - float(end) * height;
            node.bins |= bins_of(node, low + change.x, parts[i].high - float(first) * height + change.y);
            rest = end == 32 ? 0u : rest & (~0u << end);
        }
    }
    if (!plane_quadtree_bins && node.bins != 0u) node.bins = ~0u;
    return node;
}

// How much of the heights around the plane is occupied. Where slabs have no end, where they begin: the depth that they reach in the middle of the cell.
float occupied(Node node)
{
    return node.low < -no_end / 2 ? node.high : bin_height(node) * float(bitCount(node.bins));
}

// The slope of the fronts, of 4 x 4 pixels. Sums are made across, so that mirrored images have mirrored planes to the last bit.
vec2 slope_of_pixels()
{
    vec4 fronts; // of the quarters
    for (int i = 0; i < 4; ++i)
    {
        int corner = (i & 1) * 2 + (i >> 1) * 8;
        fronts[i]  = (parts[corner].high + parts[corner + 5].high) + (parts[corner + 1].high + parts[corner + 4].high);
    }
    return vec2((fronts.y + fronts.w) - (fronts.x + fronts.z), (fronts.z + fronts.w) - (fronts.x + fronts.y)) / 16;
}

// Of the four quarters, `count` of which are not empty.
vec2 mean_gradient(int count)
{
    return ((parts[0].gradient + parts[3].gradient) + (parts[1].gradient + parts[2].gradient)) / float(max(count, 1));
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy), first = cell << level;
    if (any(greaterThanEqual(cell, level_size(level)))) return;
    int count = 0;
    for (int i = 0; i < parts_count; ++i)
    {
        parts[i] = load_part(first + (place_of(i) << part_level), part_level, i / places);
        count += int(i < places && parts[i].bins != 0u);
    }
    // A plane through four pixels is no tighter than a level one. Above those, parents keep to their quarters' mean: a plane of another gradient would
    // have to hold theirs.
    bool fits     = level == 2 ? count == places : level > 2 && count > 0;
    vec2 gradient = level == 2 ? slope_of_pixels() : mean_gradient(count);
    Node node = node_around(vec2(0));
    if (fits && plane_quadtree_planes == plane_quadtree_planes_fitted)
    {
        Node fitted = node_around(round_gradient(gradient));
        if (occupied(fitted) < occupied(node)) node = fitted;
    }
    store_nodes(level_cell_index(first, level), pack_node(node));
}
