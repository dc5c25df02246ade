// stored_texels.glsl where 64 bits can be stored at once.
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { uint64_t name##_texels[]; };
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { u64vec2 name##_texels[]; };
uint64_t to_stored(uvec2 words) { return packUint2x32(words); }
u64vec2  to_stored(uvec4 words) { return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw)); }
#define STORE_TEXEL(name, index, words) name##_texels[index] = to_stored(words)
