// The depth of every pixel, 0 where there is nothing: level 0 of the depth pyramid (framework/render/depth_pyramid.h). After size_px.
#ifndef DEPTH_BINDING
#define DEPTH_BINDING 1
#endif
#ifdef WRITES_DEPTH
#define DEPTH_ACCESS writeonly
#else
#define DEPTH_ACCESS readonly
#endif
layout(set = 0, binding = DEPTH_BINDING, r32f) uniform DEPTH_ACCESS imageBuffer depth_words;

// Row by row; a row is of even length, so that two pixels lie where the pyramid has a cell.
int depth_word(ivec2 pixel)
{
    return pixel.y * ((size_px.x + 1) & ~1) + pixel.x;
}

#ifndef WRITES_DEPTH
float load_depth(ivec2 pixel)
{
    return imageLoad(depth_words, depth_word(pixel)).x;
}
#endif
