// A random number for each pixel, for techniques.
#include "api/hash.glsl"

// In [0, 1), always the same for the same pixel, unlike its neighbours'.
real random_of(ivec2 pixel) { return real(pcg(pcg(uint(pixel.x)) + uint(pixel.y)) >> 8) / real(1 << 24); }
