// What is kept of each ray beside its result: counts of work, compiled out of the pipelines that are timed, and whether it met a surface that faces away.
// An invocation traces one ray, or several with the manifest's rays_per_invocation: then `lane` says for which one counts; LANES - 1 counts for none.
#ifndef RAYS_PER_INVOCATION
#define RAYS_PER_INVOCATION 1
#define LANES 1
const int lane = 0;
#else
#define LANES (RAYS_PER_INVOCATION + 1)
int lane = 0;
#endif
#ifndef STRUCTURES // that the technique reads
#define STRUCTURES 0
#endif

bool lane_met_facing_away[LANES];

void note_facing_away() { lane_met_facing_away[lane] = true; }
bool met_facing_away() { return lane_met_facing_away[lane]; }

#ifdef COUNT_WORK
uint depth_fetches[LANES];
uint structure_fetches[LANES * (STRUCTURES + 1)];
#endif

void reset_counters()
{
    for (int i = 0; i < LANES; ++i) lane_met_facing_away[i] = false;
#ifdef COUNT_WORK
    for (int i = 0; i < LANES; ++i) depth_fetches[i] = 0;
    for (int i = 0; i < LANES * (STRUCTURES + 1); ++i) structure_fetches[i] = 0;
#endif
}

void count_depth_fetch(bool counts)
{
#ifdef COUNT_WORK
    depth_fetches[lane] += uint(counts);
#endif
}

void count_depth_fetch() { count_depth_fetch(true); }

// structure: STRUCTURE_NAME, as the framework defines it for each structure that the technique reads.
void count_fetch(int structure, bool counts)
{
#ifdef COUNT_WORK
    structure_fetches[LANES * structure + lane] += uint(counts);
#endif
}

void count_fetch(int structure) { count_fetch(structure, true); }
