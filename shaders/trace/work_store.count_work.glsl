// What tracing a ray took. Of each ray: steps, depth fetches, fetches of each structure; of what is no answer its status and pixel.
layout(set = 0, binding = 11, scalar) buffer Work { uint work[]; };
#define WORK_WORDS (2 + max(STRUCTURES, 1))

void begin_work()
{
    for (int i = 0; i < LANES; ++i) depth_fetches[i] = 0;
    for (int i = 0; i < LANES * (STRUCTURES + 1); ++i) structure_fetches[i] = 0;
}

void store_work(uint index, TraceResult result, bool answers, int own_lane)
{
    uint first = index * WORK_WORDS;
    work[first]     = answers ? result.steps : result.status;
    work[first + 1] = answers ? depth_fetches[own_lane] : result.pixel.x;
    work[first + 2] = result.pixel.y; // overwritten, but for what is no answer
    for (int structure = 0; answers && structure < STRUCTURES; ++structure)
        work[first + 2 + structure] = structure_fetches[LANES * structure + own_lane];
}
