// stored_texels.glsl for devices that write texels as storage buffers.
#include "layout/texels.glsl"
#define STORED_TEXELS_2(place, name) BUFFER_OF(place, name, writeonly, uvec2)
#define STORED_TEXELS_4(place, name) BUFFER_OF(place, name, writeonly, uvec4)
#define STORE_TEXEL(name, index, words) name##_texels[index] = words
