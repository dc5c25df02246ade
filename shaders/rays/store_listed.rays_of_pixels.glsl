// store_listed.glsl where the list holds pixels alone.
#include "layout/stored_words.glsl"

STORED_WORDS(5, Rays)

void store_ray(uint index, ivec2 pixel, int ray) { STORE_WORD(Rays, index, pack_pixel(pixel, 0)); }
