// The buffers of structures.
#include "layout/texels.glsl"
#include "layout/stored_texels.glsl"
#include "layout/stored_words.glsl"

// The buffers of structures are declared through these (framework/trace/structure_passes.cpp): load_NAME(index), store_NAME(index, value).
#define LOADED_BUFFER(place, name, type, words, from_bits, swizzle) \
    LOADED_TEXELS_##words(place, name##_loaded)                     \
    type load_##name(int index) { return from_bits(LOAD_TEXEL(name##_loaded, index).swizzle); }
#define STORED_BUFFER_1(place, name, type, to_bits) \
    STORED_WORDS(place, name##_stored)              \
    void store_##name(int index, type value) { STORE_WORD(name##_stored, index, to_bits(value)); }
#define STORED_BUFFER_2(place, name, type, to_bits) \
    STORED_TEXELS_2(place, name##_stored)           \
    void store_##name(int index, type value) { STORE_TEXEL(name##_stored, index, to_bits(value)); }
#define STORED_BUFFER_4(place, name, type, to_bits) \
    STORED_TEXELS_4(place, name##_stored)           \
    void store_##name(int index, type value) { STORE_TEXEL(name##_stored, index, to_bits(value)); }
// Doubles have no texel format.
#define LOADED_DOUBLES(place, name, type)                                                            \
    layout(set = 0, binding = place, scalar) readonly buffer name##_loaded { type name##_elements[]; }; \
    type load_##name(int index) { return name##_elements[index]; }
#define STORED_DOUBLES(place, name, type)                                                                    \
    layout(set = 0, binding = place, scalar) writeonly buffer name##_stored { type name##_stored_elements[]; }; \
    void store_##name(int index, type value) { name##_stored_elements[index] = value; }
