// stored_words.glsl for devices that write texels as storage buffers.
#include "layout/texels.glsl"
#define STORED_WORDS(place, name) BUFFER_OF(place, name, writeonly, uint)
#define STORE_WORD(name, index, word) name##_texels[index] = word
