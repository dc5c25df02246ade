// Traces the list of rays with the technique that the framework composes in: its parameters, then its trace().
#include "trace_api.glsl"
#include "technique/parameters"
#include "technique/trace.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;

layout(set = 0, binding = 4, scalar) readonly buffer RayCount { uint ray_count; };
layout(set = 0, binding = 5, scalar) readonly buffer RayOrigins { real3 ray_origin[]; };
layout(set = 0, binding = 6, scalar) readonly buffer RayDeltas { real3 ray_delta[]; };
layout(set = 0, binding = 7, scalar) readonly buffer RayLengths { real ray_length_m[]; };
layout(set = 0, binding = 8, scalar) readonly buffer RayPixels { uint ray_pixel[]; };
layout(set = 0, binding = 9, scalar) writeonly buffer HitPixels { uint hit_pixel[]; }; // number = status
layout(set = 0, binding = 10, scalar) writeonly buffer HitTs { real hit_t[]; };
#ifdef COUNT_WORK
layout(set = 0, binding = 11, scalar) writeonly buffer Work { uvec3 work[]; }; // steps, depth fetches, pyramid fetches
#endif

void main()
{
    uint index = (gl_WorkGroupID.y * MAX_GROUPS_X + gl_WorkGroupID.x) * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count) return;
    Ray ray;
    ray.origin      = ray_origin[index];
    ray.delta       = ray_delta[index];
    ray.length_m    = ray_length_m[index];
    ray.end_status  = unpack_status(ray_pixel[index]);
    ray.start_pixel = clamp(ivec2(floor(ray.origin.xy)), ivec2(0), size_px - 1);

    // A ray that runs exactly along the right or lower image border runs in the last column or row: off the border, it crosses none.
    bvec2 along_border = bvec2(ray.delta.x == real(0) && ray.origin.x == real(size_px.x), ray.delta.y == real(0) && ray.origin.y == real(size_px.y));
    ray.origin.xy -= real2(along_border) * real(0.5);

    TraceResult result = trace(ray);
    hit_pixel[index]   = pack_pixel(result.pixel, result.status);
    hit_t[index]       = result.t;
#ifdef COUNT_WORK
    work[index] = uvec3(result.steps, depth_fetches, pyramid_fetches);
#endif
}
