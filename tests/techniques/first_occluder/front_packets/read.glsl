#include "hiz_packets/ray_packets/read.glsl"
