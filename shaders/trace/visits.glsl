// What a ray looks at, in order, for `ssrlab ray`. Compiled out of every other pipeline. After trace/work_counters.glsl.
#ifdef RECORD_VISITS
#include "trace/recorded_visits.glsl"
#else
void record_visit(ivec2 pixel, int level) {}
void note_interval(real t_in, real t_out) {}
#endif
