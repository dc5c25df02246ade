#include "surfaces/box/held.glsl"
