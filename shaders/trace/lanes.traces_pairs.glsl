// lanes.glsl of two rays an invocation: `lane` says for which one counts; 2 counts for none.
#define LANES 3
int lane = 0;
