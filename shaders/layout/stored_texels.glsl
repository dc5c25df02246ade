// Stores two or four words at once. stored_texels.stores_64_bits.glsl stands for this file where the device has 64-bit integers and its storage buffers
// are large enough: lavapipe stores a texel word by word, each in a loop over its lanes, but 64 bits of a storage buffer at once.
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform writeonly uimageBuffer name;
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform writeonly uimageBuffer name;
uvec4 to_stored(uvec2 words) { return uvec4(words, 0, 0); }
uvec4 to_stored(uvec4 words) { return words; }
#define STORE_TEXEL(name, index, words) imageStore(name, int(index), to_stored(words))
