// As trace.comp, two rays an invocation: the technique defines trace_pair(Ray a, Ray b, out TraceResult result_a, out TraceResult result_b).
#include "layout/workgroups.glsl"
// On a GPU a workgroup takes two groups of 64 rays, so that no wave of 64 is half empty (PAIR_GROUPS). The launch has a workgroup for each group: half of
// them find no rays.
#undef work_group
#define work_group() (folded_group() * PAIR_GROUPS + gl_LocalInvocationID.x / (RAYS_PER_GROUP / 2))
#include "api/trace_api.glsl"
#include "technique/parameters"
#include "technique/structures"
#include "technique/trace.glsl"
#include "trace/listed_ray.glsl"

layout(local_size_x = PAIR_GROUPS * RAYS_PER_GROUP / 2) in;

void main()
{
    // Eight neighbouring invocations take 16 rays that follow each other: the first eight, and the eight after those.
    uint place = gl_LocalInvocationID.x % (RAYS_PER_GROUP / 2), index = work_group() * RAYS_PER_GROUP + (place & ~7) + place, second = index + 8;
    begin_work();
    if (index >= ray_count) return;
    bool        is_pair = second < ray_count;
    TraceResult result, second_result;
    trace_pair(load_ray(index), load_ray(is_pair ? second : index), result, second_result);
    store_result(index, result, 0);
    if (is_pair) store_result(second, second_result, 1);
}
