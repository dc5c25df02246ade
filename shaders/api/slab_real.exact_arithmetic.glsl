// slab_real.glsl for arithmetic = exact.
#define slab_real double
