// Writes what rays found in the second layer over their misses in the first.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "layout/packed_hit.glsl"
#include "layout/store_hit.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
STORED_HITS(9, Hits)
layout(set = 0, binding = 11, scalar) readonly buffer DerivedCount { uint derived_count; };
layout(set = 0, binding = 12, scalar) readonly buffer DerivedSources { uint derived_source[]; };
LOADED_HITS(13, DerivedHits)

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= derived_count) return;
    PackedHit hit = texel_to_hit(LOAD_TEXEL(DerivedHits, index));
    if (unpack_status(hit.pixel) != TRACE_HIT) return;
    hit.pixel = pack_pixel(unpack_pixel(hit.pixel), status_to_number(TRACE_HIT, 1));
    STORE_TEXEL(Hits, derived_source[index], hit_to_texel(hit.pixel, hit.t));
}
