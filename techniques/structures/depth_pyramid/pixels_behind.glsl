// What a cell's four pixels hold in the layers behind the first one; with LAYERS > 1.
const int pixels_behind = 4 * (LAYERS - 1);

// Of one of these; nothing beyond the image.
Range pixel_behind(ivec2 first, int i)
{
    ivec2 pixel = first + ivec2(i & 1, i >> 1 & 1);
    int   layer = 1 + i / 4;
    uvec2 words = all(lessThan(pixel, size_px)) ? load_layer(pixel, layer) : uvec2(0);
    return pixel_range(pixel, layer, words.x, words.y);
}

// Of all of them.
Range range_behind(ivec2 first)
{
    Range range = nothing;
    for (int i = 0; i < pixels_behind; ++i) range = unite(range, pixel_behind(first, i));
    return range;
}

// The bins that they fill.
uint bins_behind(ivec2 first, uvec2 cell)
{
    uint bins = 0u;
    for (int i = 0; i < pixels_behind; ++i) bins |= bins_of_pixel(cell, pixel_behind(first, i));
    return bins;
}
