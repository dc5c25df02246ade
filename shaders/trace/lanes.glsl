// Which ray of the invocation counts: there is one.
#define LANES 1
const int lane = 0;
