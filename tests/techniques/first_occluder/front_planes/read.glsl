#include "hiz_packets/patch_planes/read.glsl"
