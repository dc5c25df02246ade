// The solid ends where the next surface shows its back.
#include "layout/solid_image.glsl"

const bool has_solids = true;

float load_solid(ivec2 pixel, int layer)
{
    float solid = load_solid_image(pixel, layer);
    return solid > 0.0 ? solid : 1e30;
}
