// The depth where the solid behind the pixel's surface in a layer ends; nearer than everything where there is none.
#include "layout/solid_image.glsl"

float load_solid(ivec2 pixel, int layer)
{
    float solid = load_solid_image(pixel, layer);
    return solid > 0.0 ? solid : 1e30;
}
