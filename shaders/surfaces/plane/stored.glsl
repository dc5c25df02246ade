// Planes and solids as the G-buffer stores them.
#ifndef SSRLAB_STORED_PLANES
#define SSRLAB_STORED_PLANES
#ifdef PIXEL_SOLIDS
layout(set = 0, binding = 13, r32f) uniform readonly image2D solid_image;
#endif

// Of depth, from one pixel to the next; NaN where the pixel has no usable plane. framework/core/plane_gradient.h packs it.
vec2 unpack_gradient(uint words) { return uintBitsToFloat(uvec2(words & 0xFFFF0000u, words << 16)); }

bool has_plane(vec2 gradient) { return (floatBitsToUint(gradient.x) & 0x7FFFFFFFu) <= 0x7F800000u; }

// The depth where the solid behind the pixel ends; nearer than everything where there is none.
float load_solid(ivec2 pixel)
{
#ifdef PIXEL_SOLIDS
    float solid = imageLoad(solid_image, pixel).x;
    return solid > 0.0 ? solid : 1e30;
#else
    return 1e30;
#endif
}

// How far the back lies below the plane: 1/1024 of the distance.
real plane_tolerance(real depth) { return (orthographic == 0 ? depth : far_m / (far_m - near_m) - depth) / real(1024); }
#endif
