// Where the planes of pixels lie: behind the cells.
#ifndef SSRLAB_PLANE_PLACES
#define SSRLAB_PLANE_PLACES
#include "layout/cell_places.glsl"
#include "layout/planes.h"

// Of the two words of a pixel with its plane.
int plane_index(ivec2 pixel)
{
    return planes_first(size_px.x, pyramid_height) + strip_index(pixel.x, pixel.y, planes_rows(size_px.y));
}
#endif
