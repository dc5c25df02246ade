// How techniques read the depth pyramid. A cell is named by its level and any of its pixels; level 0 is the pixels themselves.
#include "cell.glsl"

// The coarsest level that is there.
int pyramid_top() { return min(depth_pyramid_top_level, pyramid_levels()); }

// What a cell of any level holds. Pixels and cells are read from one place.
struct CellContent
{
    real  depth; // level 0
    uvec2 cell;  // its words: level >= 1 as cell.glsl says, level 0 as fetch_pixel() does
};

// The cell of a level that holds a pixel; counted.
CellContent fetch_cell(ivec2 pixel, int level)
{
    bool leaf = level == 0;
    count_depth_fetch(leaf);
    count_fetch(STRUCTURE_depth_pyramid, !leaf);
    record_visit(pixel, level);
    uvec2 words = load_cell(pixel, level);
    return CellContent(real(leaf ? depth_in(words, pixel) : 0.0), words);
}

// May the ray touch a surface inside that cell between two crossings? At level 0 the answer is touches_surface()'s; above, no means no for all its pixels.
bool touches_cell(Ray ray, Grid grid, ivec2 pixel, int level, CellContent content, crossing t_in, crossing t_out)
{
    bool leaf    = level == 0;
    vec2 covered = covered_depths(ray, grid, t_in, t_out);
    // Both answers, then a choice: cheaper than a branch.
    // A cell's words may be no usable numbers; as floats some of them would make the arithmetic slow.
    PixelSurface surface = surface_at(ray, pixel, 0, leaf ? content.cell : uvec2(0));
    bool pixel_met = meets(ray, grid, surface, t_in, t_out), cell_touched = cell_may_touch(content.cell, covered.x, covered.y);
    return leaf ? ends_at(ray, surface, pixel_met, crossing_to_t(grid, t_in)) || touches_layers(ray, grid, pixel, t_in, t_out) : cell_touched;
}

// The nearest depth of that cell: no pixel of it is nearer. Negative or 0 where there is nothing.
real fetch_front(ivec2 pixel, int level)
{
    CellContent content = fetch_cell(pixel, level);
    return level == 0 ? content.depth : real(uintBitsToFloat(content.cell.x));
}
