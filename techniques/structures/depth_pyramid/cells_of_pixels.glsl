// Cells of level 1, from pixels. Around the image there is background.
#include "make_cells.glsl"
#if LAYERS > 1
#include "pixels_behind.glsl"
#else
Range range_behind(ivec2 first) { return nothing; }
uint  bins_behind(ivec2 first, uvec2 cell) { return 0u; }
#endif

// The cell of two pixels and the two below them: their depths, and their gradients.
uvec2 cell_of_pixels(ivec2 first, uvec4 depths, uvec4 gradients)
{
    Range a = pixel_range(first, 0, depths.x, gradients.x), b = pixel_range(first + ivec2(1, 0), 0, depths.y, gradients.y);
    Range c = pixel_range(first + ivec2(0, 1), 0, depths.z, gradients.z), d = pixel_range(first + 1, 0, depths.w, gradients.w);
    uvec2 cell = cell_of_range(unite(range_behind(first), unite(unite(a, b), unite(c, d))));
    cell.y     = bins_of_pixel(cell, a) | bins_of_pixel(cell, b) | bins_of_pixel(cell, c) | bins_of_pixel(cell, d) | bins_behind(first, cell);
    return finished(cell);
}

// Two cells side by side.
uvec4 two_cells_of_pixels(ivec2 cell)
{
    ivec2 first = 2 * cell, below = first + ivec2(0, 1);
    uvec4 upper = load_pair(pair_index(cell * ivec2(1, 2), pyramid_root)), lower = load_pair(pair_index(cell * ivec2(1, 2) + ivec2(0, 1), pyramid_root));
    uvec4 upper_gradients = load_gradients(first), lower_gradients = load_gradients(below);
    return uvec4(cell_of_pixels(first, uvec4(upper.xy, lower.xy), uvec4(upper_gradients.xy, lower_gradients.xy)),
                 cell_of_pixels(first + ivec2(2, 0), uvec4(upper.zw, lower.zw), uvec4(upper_gradients.zw, lower_gradients.zw)));
}
