// The buffers of structures.
#ifndef SSRLAB_STRUCTURE_BUFFERS
#define SSRLAB_STRUCTURE_BUFFERS
#include "layout/stored_texels.glsl"

// The buffers of structures are declared through these (framework/render/structure_passes.cpp): load_NAME(index), store_NAME(index, value).
#define LOADED_BUFFER(place, name, type, format, from_bits, words)                     \
    layout(set = 0, binding = place, format) uniform readonly uimageBuffer name##_loaded; \
    type load_##name(int index) { return from_bits(imageLoad(name##_loaded, index).words); }
#define STORED_BUFFER_1(place, name, type, to_bits)                                    \
    layout(set = 0, binding = place, r32ui) uniform writeonly uimageBuffer name##_stored; \
    void store_##name(int index, type value) { imageStore(name##_stored, index, uvec4(to_bits(value))); }
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
#endif
