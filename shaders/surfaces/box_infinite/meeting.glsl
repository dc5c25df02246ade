#include "surfaces/box/meeting.glsl"
