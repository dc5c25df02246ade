// How the texels of the lists and of the depth are read and written: one word each, two or four.
#ifndef SSRLAB_TEXELS
#define SSRLAB_TEXELS
// Buffers are read as texels: lavapipe loads a texel once for each lane, and needs a dozen instructions a lane for a word of a storage buffer. It stores
// a texel word by word, each in a loop over its lanes, but 64 bits of a storage buffer at once: texels are stored so where the device has 64-bit
// integers and its storage buffers are large enough (STORES_64_BITS). A device whose texel buffers are too small for pictures reads and writes the same
// bytes as storage buffers (PLAIN_BUFFERS, framework/gpu/gpu.h).
#ifdef PLAIN_BUFFERS
#include "layout/plain_texels.glsl"
#else
#define LOADED_TEXELS_1(place, name) layout(set = 0, binding = place, r32ui) uniform readonly uimageBuffer name;
#define LOADED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform readonly uimageBuffer name;
#define LOADED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform readonly uimageBuffer name;
#define LOAD_TEXEL(name, index) imageLoad(name, int(index))
#define STORED_WORDS(place, name) layout(set = 0, binding = place, r32ui) uniform writeonly uimageBuffer name;
#define STORE_WORD(name, index, word) imageStore(name, int(index), uvec4(word))
#ifndef STORES_64_BITS
#include "layout/texels_by_words.glsl"
#else
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
uint64_t to_stored(uvec2 words) { return packUint2x32(words); }
u64vec2  to_stored(uvec4 words) { return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw)); }
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { uint64_t name##_texels[]; };
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { u64vec2 name##_texels[]; };
#define STORE_TEXEL(name, index, words) name##_texels[index] = to_stored(words)
#endif
#endif
#endif
