#define IN_FRONT
#include "hiz_packets/patch_planes/build.comp"
