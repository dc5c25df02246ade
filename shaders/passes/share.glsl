// A part of a whole. 1 where it is the whole, which a quotient does not promise: a GPU's may lie below (Vulkan 1.3, "Precision of Individual
// Operations"), and passes that fill up what is less than 1 would then run on every pixel.
#ifndef SSRLAB_SHARE
#define SSRLAB_SHARE
float share_of(float part, float whole) { return part == whole ? 1.0 : part / whole; }
#endif
