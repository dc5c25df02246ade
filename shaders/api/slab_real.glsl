// The number type of the slab's constants.
#define slab_real real
