// facing_away.glsl of two rays an invocation.
#include "trace/lanes.glsl"

bool lane_met_facing_away[LANES] = bool[](false, false, false);
#define met_facing_away lane_met_facing_away[lane]
