// Texels of one float, as layout/texels.glsl has them of words.
#ifndef SSRLAB_FLOAT_TEXELS
#define SSRLAB_FLOAT_TEXELS
#include "layout/texels.glsl"

#ifdef PLAIN_BUFFERS
#define LOADED_FLOATS(place, name) BUFFER_OF(place, name, readonly, float)
#define STORED_FLOATS(place, name) BUFFER_OF(place, name, writeonly, float)
#define STORE_FLOAT(name, index, value) name##_texels[index] = value
#else
#define LOADED_FLOATS(place, name) layout(set = 0, binding = place, r32f) uniform readonly imageBuffer name;
#define STORED_FLOATS(place, name) layout(set = 0, binding = place, r32f) uniform writeonly imageBuffer name;
#define STORE_FLOAT(name, index, value) imageStore(name, int(index), vec4(value))
#endif
#endif
