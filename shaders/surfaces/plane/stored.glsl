// Planes and solids as the G-buffer stores them.
#ifndef SSRLAB_STORED_PLANES
#define SSRLAB_STORED_PLANES
#if defined(SURFACE_SOLID) || defined(SOLID_ENDLESS)
#define HOLDS_SOLID
#endif
#ifdef SURFACE_SOLID
layout(set = 0, binding = 13, r32f) uniform readonly image2D solid_image;
#endif
#if LAYERS > 1
#include "layout/load_layers.glsl"
#endif

// Of depth, from one pixel to the next; NaN where the pixel has no usable plane. framework/core/plane_gradient.h packs it.
vec2 unpack_gradient(uint words) { return uintBitsToFloat(uvec2(words & 0xFFFF0000u, words << 16)); }

bool has_plane(vec2 gradient) { return (floatBitsToUint(gradient.x) & 0x7FFFFFFFu) <= 0x7F800000u; }

// The depth where the solid behind the pixel's surface in a layer ends; nearer than everything where there is none.
float load_solid(ivec2 pixel, int layer)
{
#if defined(SOLID_ENDLESS)
    return -1e30;
#elif defined(SURFACE_SOLID)
#if LAYERS > 1
    float solid = layer > 0 ? load_layer_solid(pixel, layer) : imageLoad(solid_image, pixel).x;
#else
    float solid = imageLoad(solid_image, pixel).x;
#endif
    return solid > 0.0 ? solid : 1e30;
#else
    return 1e30;
#endif
}

// How far the back lies below the plane: 1/1024 of the distance.
real plane_tolerance(real depth) { return (orthographic == 0 ? depth : far_m / (far_m - near_m) - depth) / real(1024); }
#endif
