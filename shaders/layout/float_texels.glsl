// Texels of one float, as layout/texels.glsl has them of words.
#include "layout/texels.glsl"
#define LOADED_FLOATS(place, name) layout(set = 0, binding = place, r32f) uniform readonly imageBuffer name;
#define STORED_FLOATS(place, name) layout(set = 0, binding = place, r32f) uniform writeonly imageBuffer name;
#define STORE_FLOAT(name, index, value) imageStore(name, int(index), vec4(value))
