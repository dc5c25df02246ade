// Patches are this many bits of a pixel's coordinates wide and high.
#define PATCH_BITS 4
