#define IN_FRONT
#include "hiz_packets/ray_packets/build.comp"
