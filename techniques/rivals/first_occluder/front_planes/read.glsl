#include "structures/patch_planes/read.glsl"
