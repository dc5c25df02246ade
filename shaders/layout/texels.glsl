// Words in buffers, one, two or four at a time. Buffers are read as texels: lavapipe loads a texel once for each lane, and needs a dozen instructions
// a lane for a word of a storage buffer. Where texel buffers are too small for pictures, texels.plain_buffers.glsl reads the same bytes as storage
// buffers (framework/gpu/gpu.h).
#define LOADED_TEXELS_1(place, name) layout(set = 0, binding = place, r32ui) uniform readonly uimageBuffer name;
#define LOADED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform readonly uimageBuffer name;
#define LOADED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform readonly uimageBuffer name;
#define LOAD_TEXEL(name, index) imageLoad(name, int(index))
#define TEXEL_COUNT(name) imageSize(name)
