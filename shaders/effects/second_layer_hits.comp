// Writes what rays found in the second layer over their misses in the first.
#include "work_group.glsl"
#include "view.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 9, scalar) writeonly buffer HitPixels { uint hit_pixel[]; };
layout(set = 0, binding = 10, scalar) writeonly buffer HitTs { real hit_t[]; };
layout(set = 0, binding = 11, scalar) readonly buffer DerivedCount { uint derived_count; };
layout(set = 0, binding = 12, scalar) readonly buffer DerivedSources { uint derived_source[]; };
layout(set = 0, binding = 13, scalar) readonly buffer DerivedHitPixels { uint derived_hit_pixel[]; };
layout(set = 0, binding = 14, scalar) readonly buffer DerivedHitTs { real derived_hit_t[]; };

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= derived_count) return;
    uint found = derived_hit_pixel[index];
    if (unpack_status(found) != TRACE_HIT) return;
    hit_pixel[derived_source[index]] = found | uint(TRACE_SECOND_LAYER) << (2 * PIXEL_BITS);
    hit_t[derived_source[index]]     = derived_hit_t[index];
}
