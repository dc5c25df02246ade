// How the texels of the lists and of the depth are read and written: one word each, two or four.
#ifndef SSRLAB_TEXELS
#define SSRLAB_TEXELS
// Buffers are read as texels: lavapipe loads a texel once for each lane, and needs a dozen instructions a lane for a word of a storage buffer. It stores
// a texel word by word, each in a loop over its lanes, but 64 bits of a storage buffer at once: texels are stored so where the device has 64-bit
// integers and its storage buffers are large enough (STORES_64_BITS). A device whose texel buffers are too small for pictures reads and writes the same
// bytes as storage buffers (PLAIN_BUFFERS, framework/gpu/gpu.h).
#ifdef PLAIN_BUFFERS
uvec4 to_loaded(uint word) { return uvec4(word, 0, 0, 1); }
uvec4 to_loaded(uvec2 words) { return uvec4(words, 0, 1); }
uvec4 to_loaded(uvec4 words) { return words; }
vec4 to_loaded(float value) { return vec4(value, 0, 0, 1); }
#define BUFFER_OF(place, name, access, type) layout(set = 0, binding = place, scalar) access buffer name { type name##_texels[]; };
#define LOADED_TEXELS_1(place, name) BUFFER_OF(place, name, readonly, uint)
#define LOADED_TEXELS_2(place, name) BUFFER_OF(place, name, readonly, uvec2)
#define LOADED_TEXELS_4(place, name) BUFFER_OF(place, name, readonly, uvec4)
#define LOADED_FLOATS(place, name) BUFFER_OF(place, name, readonly, float)
#define LOAD_TEXEL(name, index) to_loaded(name##_texels[index])
#define STORED_WORDS(place, name) BUFFER_OF(place, name, writeonly, uint)
#define STORED_FLOATS(place, name) BUFFER_OF(place, name, writeonly, float)
#define STORE_WORD(name, index, word) name##_texels[index] = word
#define STORE_FLOAT(name, index, value) name##_texels[index] = value
#define STORED_TEXELS_2(place, name) BUFFER_OF(place, name, writeonly, uvec2)
#define STORED_TEXELS_4(place, name) BUFFER_OF(place, name, writeonly, uvec4)
#define STORE_TEXEL(name, index, words) name##_texels[index] = words
#else
#define LOADED_TEXELS_1(place, name) layout(set = 0, binding = place, r32ui) uniform readonly uimageBuffer name;
#define LOADED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform readonly uimageBuffer name;
#define LOADED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform readonly uimageBuffer name;
#define LOADED_FLOATS(place, name) layout(set = 0, binding = place, r32f) uniform readonly imageBuffer name;
#define LOAD_TEXEL(name, index) imageLoad(name, int(index))
#define STORED_WORDS(place, name) layout(set = 0, binding = place, r32ui) uniform writeonly uimageBuffer name;
#define STORED_FLOATS(place, name) layout(set = 0, binding = place, r32f) uniform writeonly imageBuffer name;
#define STORE_WORD(name, index, word) imageStore(name, int(index), uvec4(word))
#define STORE_FLOAT(name, index, value) imageStore(name, int(index), vec4(value))
#ifdef STORES_64_BITS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
uint64_t to_stored(uvec2 words) { return packUint2x32(words); }
u64vec2  to_stored(uvec4 words) { return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw)); }
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { uint64_t name##_texels[]; };
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { u64vec2 name##_texels[]; };
#define STORE_TEXEL(name, index, words) name##_texels[index] = to_stored(words)
#else
uvec4 to_stored(uvec2 words) { return uvec4(words, 0, 0); }
uvec4 to_stored(uvec4 words) { return words; }
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform writeonly uimageBuffer name;
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform writeonly uimageBuffer name;
#define STORE_TEXEL(name, index, words) imageStore(name, int(index), to_stored(words))
#endif
#endif
#endif
