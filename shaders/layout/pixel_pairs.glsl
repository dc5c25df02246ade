// Two pixels side by side, x even: of each its depth, and no gradient.
uvec4 load_pixel_pair(ivec2 pixel)
{
    uvec4 four = load_pair(pair_index(ivec2(pixel.x >> 1, pixel.y), pyramid_root));
    uvec2 two  = (pixel.x & 2) != 0 ? four.zw : four.xy;
    return uvec4(two.x, 0, two.y, 0);
}
