// A texel of a storage buffer, widened as a texel buffer would.
uvec4 to_loaded(uint word) { return uvec4(word, 0, 0, 1); }
uvec4 to_loaded(uvec2 words) { return uvec4(words, 0, 1); }
uvec4 to_loaded(uvec4 words) { return words; }
vec4 to_loaded(float value) { return vec4(value, 0, 0, 1); }
#define BUFFER_OF(place, name, access, type) layout(set = 0, binding = place, scalar) access buffer name { type name##_texels[]; };
#define LOADED_TEXELS_1(place, name) BUFFER_OF(place, name, readonly, uint)
#define LOADED_TEXELS_2(place, name) BUFFER_OF(place, name, readonly, uvec2)
#define LOADED_TEXELS_4(place, name) BUFFER_OF(place, name, readonly, uvec4)
#define LOAD_TEXEL(name, index) to_loaded(name##_texels[index])
#define TEXEL_COUNT(name) name##_texels.length()
