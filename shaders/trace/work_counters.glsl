// What is kept of each ray beside its result: counts of work, compiled out of the pipelines that are timed, and whether it met a surface that faces away.
// An invocation traces one ray, or two (trace/trace_pairs.comp).
#ifdef TRACES_PAIRS
#include "trace/pair_lanes.glsl"
#else
#define LANES 1
const int lane = 0;
#endif

bool lane_met_facing_away[LANES];
uint depth_fetches[LANES], structure_fetches[LANES * (STRUCTURES + 1)];

void note_facing_away() { lane_met_facing_away[lane] = true; }
bool met_facing_away() { return lane_met_facing_away[lane]; }

void reset_counters()
{
    for (int i = 0; i < LANES; ++i) lane_met_facing_away[i] = false;
    for (int i = 0; i < LANES; ++i) depth_fetches[i] = 0;
    for (int i = 0; i < LANES * (STRUCTURES + 1); ++i) structure_fetches[i] = 0;
}

// structure: STRUCTURE_NAME, as the framework defines it for each structure that the technique reads.
#ifdef COUNT_WORK
void count_depth_fetch(bool counts) { depth_fetches[lane] += uint(counts); }
void count_fetch(int structure, bool counts) { structure_fetches[LANES * structure + lane] += uint(counts); }
#else
void count_depth_fetch(bool counts) {}
void count_fetch(int structure, bool counts) {}
#endif
void count_depth_fetch() { count_depth_fetch(true); }
void count_fetch(int structure) { count_fetch(structure, true); }
