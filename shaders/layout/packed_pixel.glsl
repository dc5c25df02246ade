// A pixel and how a ray ended, in one word (layout/numbers.h).
#include "layout/numbers.h"

uint pack_pixel(ivec2 pixel, int number) { return uint(pixel.x) | uint(pixel.y) << PIXEL_BITS | uint(number) << (2 * PIXEL_BITS); }

ivec2 unpack_pixel(uint packed) { return ivec2(packed, packed >> PIXEL_BITS) & ((1 << PIXEL_BITS) - 1); }

// How a ray ended, in whichever layer.
int unpack_status(uint packed) { return number_to_status(int(packed >> (2 * PIXEL_BITS))); }

int unpack_layer(uint packed) { return number_to_layer(int(packed >> (2 * PIXEL_BITS))); }
