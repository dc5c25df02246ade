#include "surfaces/plane/meeting.glsl"
