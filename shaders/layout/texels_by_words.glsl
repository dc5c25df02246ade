// layout/texels.glsl includes this where 64 bits cannot be stored at once.
uvec4 to_stored(uvec2 words) { return uvec4(words, 0, 0); }
uvec4 to_stored(uvec4 words) { return words; }
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform writeonly uimageBuffer name;
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform writeonly uimageBuffer name;
#define STORE_TEXEL(name, index, words) imageStore(name, int(index), to_stored(words))
