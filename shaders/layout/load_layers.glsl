// What lies in the layers behind the first one (docs/reference/hit_contract.md). LAYERS: how many there are, the first one among them.
#include "layout/plane_places.glsl"
#include "layout/texels.glsl"

#define DECLARE_LAYER(number, place)                                                                \
    LOADED_TEXELS_2(place, layer_##number##_cells)                                                    \
    layout(set = 0, binding = place + 1, r32f) uniform readonly image2D layer_##number##_solid_image; \
    layout(set = 0, binding = place + 2, rgba32f) uniform readonly image2D layer_##number##_normal_image;
DECLARE_LAYER(1, 16)
#if LAYERS > 2
DECLARE_LAYER(2, 19)
#define OF_LAYER_2(loaded, otherwise) layer == 2 ? (loaded) : otherwise
#else
#define OF_LAYER_2(loaded, otherwise) otherwise
#endif
#if LAYERS > 3
DECLARE_LAYER(3, 22)
#define OF_LAYER_3(loaded, otherwise) layer == 3 ? (loaded) : otherwise
#else
#define OF_LAYER_3(loaded, otherwise) otherwise
#endif
#define OF_LAYER(load, place) (OF_LAYER_3(load(3, place), OF_LAYER_2(load(2, place), load(1, place))))
#define LOAD_LAYER_CELL(number, place) LOAD_TEXEL(layer_##number##_cells, place)
#define LOAD_LAYER_SOLID(number, place) imageLoad(layer_##number##_solid_image, place)
#define LOAD_LAYER_NORMAL(number, place) imageLoad(layer_##number##_normal_image, place)

// As load_cell() at level 0: depth and gradient. layer: 1, 2, ...
uvec2 load_layer(ivec2 pixel, int layer)
{
    uvec2 words = OF_LAYER(LOAD_LAYER_CELL, plane_index(pixel)).xy;
#ifdef PIXEL_PLANES
    return words;
#else
    return words.xx; // the pixel's depth, be it the left or the right of two
#endif
}

float load_layer_solid(ivec2 pixel, int layer) { return OF_LAYER(LOAD_LAYER_SOLID, pixel).x; }

vec3 load_layer_normal(ivec2 pixel, int layer) { return OF_LAYER(LOAD_LAYER_NORMAL, pixel).xyz; }
