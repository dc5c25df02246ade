// layers_behind.glsl where there are several.
#include "layout/load_layers.glsl"

const int pixels_behind = 4 * (LAYERS - 1);

// Of one of these; nothing beyond the image.
uvec2 pixel_behind(ivec2 first, int i)
{
    ivec2 pixel = first + ivec2(i & 1, i >> 1 & 1);
    int   layer = 1 + i / 4;
    return pixel_range(pixel, layer, all(lessThan(pixel, size_px)) ? load_layer(pixel, layer) : uvec2(0));
}

uvec2 range_behind(bool of_pixels, ivec2 first)
{
    uvec2 range = nothing;
    for (int i = 0; of_pixels && i < pixels_behind; ++i) range = unite(range, pixel_behind(first, i));
    return range;
}

uint bins_behind(bool of_pixels, ivec2 first, uvec2 cell)
{
    uint bins = 0u;
    for (int i = 0; of_pixels && i < pixels_behind; ++i) bins |= bins_of_range(cell, pixel_behind(first, i));
    return bins;
}
