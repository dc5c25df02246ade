// Order and bounds of planes.
#include "surfaces/plane/sloped.glsl"
