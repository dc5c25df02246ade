#define IN_FRONT
#include "structures/ray_packets/build.comp"
