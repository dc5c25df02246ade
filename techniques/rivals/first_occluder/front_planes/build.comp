#define IN_FRONT
#include "structures/patch_planes/build.comp"
