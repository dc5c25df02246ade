// float_texels.glsl for devices that read and write texels as storage buffers.
#include "layout/texels.glsl"
#define LOADED_FLOATS(place, name) BUFFER_OF(place, name, readonly, float)
#define STORED_FLOATS(place, name) BUFFER_OF(place, name, writeonly, float)
#define STORE_FLOAT(name, index, value) name##_texels[index] = value
