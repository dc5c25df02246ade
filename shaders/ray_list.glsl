// The list of rays, for shaders that read it (rays.comp writes it). Floats come out of texel buffers: a storage buffer's words lavapipe reads
// lane by lane, those of a texel buffer for all lanes at once.
#ifndef SSRLAB_RAY_LIST
#define SSRLAB_RAY_LIST
#include "real.glsl"

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };

#ifdef REAL_IS_DOUBLE
layout(set = 0, binding = 5, scalar) readonly buffer RayOrigins { real3 ray_origins[]; };
layout(set = 0, binding = 6, scalar) readonly buffer RayDeltas { real3 ray_deltas[]; };
layout(set = 0, binding = 7, scalar) readonly buffer RayLengths { real ray_lengths_m[]; };

real3 ray_origin(uint ray) { return ray_origins[ray]; }
real3 ray_delta(uint ray) { return ray_deltas[ray]; }
real ray_length_m(uint ray) { return ray_lengths_m[ray]; }
#else
layout(set = 0, binding = 5, r32f) uniform readonly imageBuffer RayOrigins;
layout(set = 0, binding = 6, r32f) uniform readonly imageBuffer RayDeltas;
layout(set = 0, binding = 7, r32f) uniform readonly imageBuffer RayLengths;

#define LOAD_3(texels, first) real3(imageLoad(texels, first).x, imageLoad(texels, first + 1).x, imageLoad(texels, first + 2).x)

real3 ray_origin(uint ray) { return LOAD_3(RayOrigins, int(ray) * 3); }
real3 ray_delta(uint ray) { return LOAD_3(RayDeltas, int(ray) * 3); }
real ray_length_m(uint ray) { return imageLoad(RayLengths, int(ray)).x; }
#endif

layout(set = 0, binding = 8, r32ui) uniform readonly uimageBuffer RayPixels;

// pack_pixel() of the pixel and of the status of a miss.
uint ray_pixel(uint ray) { return imageLoad(RayPixels, int(ray)).x; }
#endif
