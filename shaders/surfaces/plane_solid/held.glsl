#include "surfaces/plane/held.glsl"
