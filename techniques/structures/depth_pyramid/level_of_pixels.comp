// Level 1 of the depth pyramid, from pixels.
#include "make_cells.glsl"

// The cell of two pixels and the two below them.
uvec2 cell_of_pixels(ivec2 first, uvec2 upper, uvec2 lower)
{
    Range a = pixel_range(first, upper.x), b = pixel_range(first + ivec2(1, 0), upper.y);
    Range c = pixel_range(first + ivec2(0, 1), lower.x), d = pixel_range(first + 1, lower.y);
    uvec2 cell = cell_of_range(unite(unite(a, b), unite(c, d)));
    cell.y     = bins_of_pixel(cell, a) | bins_of_pixel(cell, b) | bins_of_pixel(cell, c) | bins_of_pixel(cell, d);
    return finished(cell);
}

// Around the image there is background.
void main()
{
    if (any(greaterThanEqual(cell, size))) return;
    uvec4 upper = load_pair(pair_index(cell * ivec2(1, 2), pyramid_root)), lower = load_pair(pair_index(cell * ivec2(1, 2) + ivec2(0, 1), pyramid_root));
    store_cells(uvec4(cell_of_pixels(2 * cell, upper.xy, lower.xy), cell_of_pixels(2 * cell + ivec2(2, 0), upper.zw, lower.zw)));
}
