// work.glsl where work is counted.
#include "trace/lanes.glsl"

uint depth_fetches[LANES], structure_fetches[LANES * (STRUCTURES + 1)];

void count_depth_fetch(bool counts) { depth_fetches[lane] += uint(counts); }
void count_fetch(int structure, bool counts) { structure_fetches[LANES * structure + lane] += uint(counts); }
void count_depth_fetch() { count_depth_fetch(true); }
void count_fetch(int structure) { count_fetch(structure, true); }
