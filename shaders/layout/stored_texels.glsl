// How texels of two and four words are written.
#ifndef SSRLAB_STORED_TEXELS
#define SSRLAB_STORED_TEXELS
// Buffers are read as texels: lavapipe loads a texel once for each lane, and needs a dozen instructions a lane for a word of a storage buffer. It stores
// a texel word by word, each in a loop over its lanes, but 64 bits of a storage buffer at once: texels are stored so where the device has 64-bit
// integers and its storage buffers are large enough (STORES_64_BITS).
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
