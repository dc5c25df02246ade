// The depth of every pixel, BACKGROUND_DEPTH where there is nothing: level 0 of the depth pyramid (framework/render/depth_pyramid.h). After size_px.
#ifndef DEPTH_BINDING
#define DEPTH_BINDING 1
#endif
#ifdef WRITES_DEPTH
#define DEPTH_ACCESS writeonly
#else
#define DEPTH_ACCESS readonly
#endif
layout(set = 0, binding = DEPTH_BINDING, r32f) uniform DEPTH_ACCESS imageBuffer depth_words;

// Words of a row, a multiple of four: two pixels lie in the place of a cell, four in that of two.
int depth_row()
{
    return (size_px.x + 3) & ~3;
}

int depth_word(ivec2 pixel)
{
    return pixel.y * depth_row() + pixel.x;
}

#ifndef WRITES_DEPTH
float load_depth(ivec2 pixel)
{
    return imageLoad(depth_words, depth_word(pixel)).x;
}
#endif
