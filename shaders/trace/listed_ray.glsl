// Loads a ray of the list and stores what was found of it. After the technique.
#include "trace/ray_list.glsl"
#include "trace/work_store.glsl"
#include "layout/packed_pixel.glsl"
#include "layout/store_hit.glsl"
#include "layout/workgroups.glsl"

STORED_HITS(9, Hits)

Ray load_ray(uint index)
{
    PackedRay listed = packed_ray(index);
    ivec2     start  = clamp(ivec2(floor(listed.origin.xy)), ivec2(0), size_px - 1);
    real      slack  = abs(listed.delta.z) * t_rounding;
    Ray       ray    = Ray(listed.origin, listed.delta, start, listed.length_m, unpack_status(listed.pixel), slack);

    // A ray that runs exactly along the right or lower image border runs in the last column or row: off the border, it crosses none.
    bvec2 along_border = bvec2(ray.delta.x == real(0) && ray.origin.x == real(size_px.x), ray.delta.y == real(0) && ray.origin.y == real(size_px.y));
    ray.origin.xy -= real2(along_border) * real(0.5);
    return ray;
}

bool has_place(TraceResult result) { return result.status == TRACE_HIT || result.status == TRACE_STOPPED || number_to_layer(result.status) > 0; }

// Neither an unknown status, nor a hit off the image: packed, they would turn into another answer.
bool is_answer(TraceResult result)
{
    bool on_image = all(greaterThanEqual(result.pixel, ivec2(0))) && all(lessThan(result.pixel, size_px));
    bool known    = result.status > TRACE_NOT_TRACED && result.status != TRACE_IMPOSSIBLE && number_to_layer(result.status) < LAYERS;
    return known && (on_image || !has_place(result));
}

// own_lane: the lane that traced the ray; only the counters use it.
void store_result(uint index, TraceResult result, int own_lane)
{
    bool  answers = is_answer(result);
    ivec2 pixel   = answers && has_place(result) ? result.pixel : ivec2(0);
    STORE_TEXEL(Hits, index, hit_to_texel(pack_pixel(pixel, answers ? result.status : TRACE_IMPOSSIBLE), result.t));
    store_work(index, result, answers, own_lane);
}
