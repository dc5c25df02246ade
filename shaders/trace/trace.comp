// Traces the list of rays with the technique that the framework composes in: its parameters, the structures it reads, then its trace(); or, with the
// manifest's rays_per_invocation = 2, its trace_pair(Ray a, Ray b, out TraceResult result_a, out TraceResult result_b).
#include "api/trace_api.glsl"
#include "trace/ray_list.glsl"
#include "layout/packed_hit.glsl"
#include "technique/parameters"
#include "technique/structures"
#include "technique/trace.glsl"

layout(local_size_x = RAYS_PER_GROUP / RAYS_PER_INVOCATION) in;

STORED_HITS(9, Hits)
#ifdef COUNT_WORK
layout(set = 0, binding = 11, scalar) buffer Work { uint work[]; }; // of each ray: steps, depth fetches, fetches of each structure; of no answer its status and pixel
#define WORK_WORDS (2 + max(STRUCTURES, 1))
#endif

Ray load_ray(uint index)
{
    PackedRay listed = packed_ray(index);
    Ray       ray;
    ray.origin      = listed.origin;
    ray.delta       = listed.delta;
    ray.length_m    = listed.length_m;
    ray.end_status  = unpack_status(listed.pixel);
    ray.rounding    = depth_rounding(ray.delta);
    ray.start_pixel = clamp(ivec2(floor(ray.origin.xy)), ivec2(0), size_px - 1);

    // A ray that runs exactly along the right or lower image border runs in the last column or row: off the border, it crosses none.
    bvec2 along_border = bvec2(ray.delta.x == real(0) && ray.origin.x == real(size_px.x), ray.delta.y == real(0) && ray.origin.y == real(size_px.y));
    ray.origin.xy -= real2(along_border) * real(0.5);
    return ray;
}

bool has_place(TraceResult result) { return result.status == TRACE_HIT || result.status == TRACE_STOPPED; }

// Neither an unknown status, nor a hit off the image: packed, they would turn into another answer.
bool is_answer(TraceResult result)
{
    bool on_image = all(greaterThanEqual(result.pixel, ivec2(0))) && all(lessThan(result.pixel, size_px));
    return result.status > TRACE_NOT_TRACED && result.status <= TRACE_STOPPED && (on_image || !has_place(result));
}

// own_lane: that of the ray.
void store_result(uint index, TraceResult result, int own_lane)
{
    bool  answers = is_answer(result);
    ivec2 pixel   = answers && has_place(result) ? result.pixel : ivec2(0);
    STORE_TEXEL(Hits, index, hit_to_texel(PackedHit(pack_pixel(pixel, answers ? result.status : TRACE_IMPOSSIBLE), result.t)));
#ifdef COUNT_WORK
    uint first = index * WORK_WORDS;
    work[first]     = answers ? result.steps : result.status;
    work[first + 1] = answers ? depth_fetches[own_lane] : result.pixel.x;
    work[first + 2] = result.pixel.y; // overwritten, but for what is no answer
    for (int structure = 0; answers && structure < STRUCTURES; ++structure)
        work[first + 2 + structure] = structure_fetches[LANES * structure + own_lane];
#endif
}

void main()
{
    uint first = work_group() * RAYS_PER_GROUP, place = gl_LocalInvocationID.x;
    reset_counters();
#if RAYS_PER_INVOCATION == 2
    // Eight neighbouring invocations take 16 rays that follow each other: the first eight, and the eight after those.
    uint index = first + (place & ~7) + place, second = index + 8;
    if (index >= ray_count) return;
    bool        is_pair = second < ray_count;
    TraceResult result, second_result;
    trace_pair(load_ray(index), load_ray(is_pair ? second : index), result, second_result);
    store_result(index, result, 0);
    if (is_pair) store_result(second, second_result, 1);
#else
    uint index = first + place;
    if (index >= ray_count) return;
    store_result(index, trace(load_ray(index)), 0);
#endif
}
