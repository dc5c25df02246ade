// How techniques read the depth pyramid. A cell is named by its level and any of its pixels; level 0 is the pixels themselves.
#include "api/covered_depths.glsl"
#include "cell.glsl"

// The coarsest level that is there.
int pyramid_top() { return min(depth_pyramid_top_level, pyramid_levels()); }

// The two words of the cell that holds a pixel at a level; at level 0 those of the pixel, as fetch_pixel() returns them.
uvec2 fetch_cell(ivec2 pixel, int level)
{
    bool leaf = level == 0;
    count_depth_fetch(leaf);
    count_fetch(STRUCTURE_depth_pyramid, !leaf);
    record_visit(pixel, level);
    return load_cell(pixel, level);
}

// May the ray meet a surface inside that cell between two crossings? At level 0 it is the hit test; above, nothing found means nothing in all its pixels.
Contact test_cell(Ray ray, Grid grid, ivec2 pixel, int level, uvec2 words, crossing t_in, crossing t_out)
{
    bool leaf    = level == 0;
    vec2 covered = covered_depths(ray, grid, t_in, t_out);
    // Both answers, then a choice: cheaper than a branch.
    // A cell's words may be no usable numbers; as floats some of them would make the arithmetic slow.
    Contact contact = Contact(false, pixel, 0, leaf ? words : uvec2(0), crossing_to_t(grid, t_in), crossing_to_t(grid, t_out), false);
    PixelSurface surface = surface_of(ray, contact);
    bool pixel_met = meets(ray, grid, surface, t_in, t_out), cell_touched = cell_may_touch(words, covered.x, covered.y);
    contact.found  = leaf ? ends_at(ray, surface, pixel_met, contact.t_in) : cell_touched;
    return leaf ? first_of_layers(ray, grid, contact, t_in, t_out) : contact;
}
