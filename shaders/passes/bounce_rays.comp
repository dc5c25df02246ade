// From each surface that a ray hit and that reflects, the next ray: in the mirror direction of the ray that arrived.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "layout/store_ray.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/segment.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/ray_colour.glsl"
#extension GL_KHR_shader_subgroup_ballot : require

layout(local_size_x = RAYS_PER_GROUP) in;
#ifdef FURTHER
layout(set = 0, binding = 17, scalar) readonly buffer RaySources { uint ray_source[]; };
layout(set = 0, binding = 18, scalar) readonly buffer RayThroughputs { vec3 ray_throughput[]; };
#endif
layout(set = 0, binding = 19, scalar) buffer DerivedCount { uint derived_count; };
STORED_TEXELS_4(20, DerivedRays)
layout(set = 0, binding = 24, scalar) writeonly buffer DerivedSources { uint derived_source[]; }; // pixel whose reflection it belongs to
layout(set = 0, binding = 25, scalar) writeonly buffer DerivedThroughputs { vec3 derived_throughput[]; };

// What light from the hit still weighs in the reflection; 0: the ray is not followed.
vec3 throughput_of(uint index, PackedHit hit)
{
#ifdef FURTHER
    return ray_throughput[index];
#else
    if (!reflects(unpack_pixel(ray_pixel(index)))) return vec3(0);
    Found found = found_by(packed_ray(index), hit);
#if defined(LOBE_RAYS) && defined(ENVIRONMENT)
    return vec3(found.weight * found.attenuation); // the rest is the environment's
#else
    return vec3(found.weight > 0.0 ? found.attenuation : 0.0);
#endif
#endif
}

void main()
{
    uint      index  = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    PackedHit listed = PackedHit(0, real(0));
    if (index < ray_count) listed = packed_hit(index);
    ivec2 hit      = unpack_pixel(listed.pixel);
    bool  follows  = unpack_status(listed.pixel) == TRACE_HIT && unpack_layer(listed.pixel) == 0 && reflects(hit);
    real3 arriving = real3(0), normal = real3(0);
    vec3  throughput = vec3(0);
    if (follows)
    {
        arriving   = ray_direction(packed_ray(index));
        normal     = normal_at(hit);
        throughput = throughput_of(index, listed);
        follows    = throughput != vec3(0) && dot(arriving, normal) < real(0);
    }

    uvec4 ballot = subgroupBallot(follows);
    uint  first  = 0;
    if (subgroupElect()) first = atomicAdd(derived_count, subgroupBallotBitCount(ballot));
    first = subgroupBroadcastFirst(first);
    if (!follows) return;

    uint    derived  = first + subgroupBallotExclusiveBitCount(ballot);
    real2   centre   = real2(hit) + real(0.5);
    real    depth    = load_depth(hit);
    Segment segment  = make_segment(centre, depth, mirrored(to_df64(arriving), normal));
    PackedRay next   = segment_to_packed_ray(segment, hit);
    STORE_RAY(DerivedRays, derived, next);
    derived_throughput[derived] = throughput;
#ifdef FURTHER
    derived_source[derived] = ray_source[index];
#else
    derived_source[derived] = pack_pixel(unpack_pixel(ray_pixel(index)), 0);
#endif
}
