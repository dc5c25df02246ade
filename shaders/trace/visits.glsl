// What a ray looks at, in order, for `ssrlab ray`: visits.record_visits.glsl keeps it, every other pipeline does not.
void record_visit(ivec2 pixel, int level) {}
void note_interval(real t_in, real t_out) {}
