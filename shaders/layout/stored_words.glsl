// Stores one word at a time.
#define STORED_WORDS(place, name) layout(set = 0, binding = place, r32ui) uniform writeonly uimageBuffer name;
#define STORE_WORD(name, index, word) imageStore(name, int(index), uvec4(word))
