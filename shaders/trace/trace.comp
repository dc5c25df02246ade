// Traces the list of rays with the technique that the framework composes in: its parameters, the structures it reads, then its trace().
#include "api/trace_api.glsl"
#include "technique/parameters"
#include "technique/structures"
#include "technique/trace.glsl"
#include "trace/listed_ray.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    begin_work();
    if (index < ray_count) store_result(index, trace(load_ray(index)), 0);
}
