#include "structures/ray_packets/read.glsl"
