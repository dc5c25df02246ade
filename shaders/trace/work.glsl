// Counts of work, which work.count_work.glsl keeps: timed pipelines have none. structure: STRUCTURE_NAME, as the framework defines it for each
// structure that the technique reads.
void count_depth_fetch() {}
void count_depth_fetch(bool counts) {}
void count_fetch(int structure) {}
void count_fetch(int structure, bool counts) {}
