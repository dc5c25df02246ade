// Where a ray hit a surface that reflects, the colour is that surface's own with its reflection of the previous frame, as the camera saw it.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/ray_colour.glsl"
#include "passes/beta.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D reflection_image;

#ifdef REPROJECTED
#include "passes/previous_frame.glsl"
#include "passes/history_lookup.glsl"

vec4 reflection_before(ivec2 pixel)
{
    History found;
    if (find_history(pixel, found) != HISTORY_ACCUMULATED || found.reflection.a <= 0.0) return vec4(0);
    return vec4(found.reflection.rgb / found.reflection.a, found.reflection.a);
}
#else
layout(set = 0, binding = 17, rgba16f) uniform readonly image2D history_image; // the previous frame's reflection_image

vec4 reflection_before(ivec2 pixel) { return imageLoad(history_image, pixel); }
#endif

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count) return;
    ivec2 pixel  = unpack_pixel(ray_pixel(index));
    PackedHit listed = packed_hit(index);
    ivec2 hit    = unpack_pixel(listed.pixel);
    bool  mirror = unpack_status(listed.pixel) == TRACE_HIT && unpack_layer(listed.pixel) == 0 && reflects(hit);
    if (!mirror || !reflects(pixel)) return;
    Found found = found_by(packed_ray(index), listed);
    if (found.weight <= 0.0) return;
    vec4 history = reflection_before(hit);
    vec3 colour  = with_reflection(hit, to_camera_vs(hit), found.light, vec3(0), history.rgb, history.a);
    imageStore(reflection_image, pixel, vec4(colour * found.attenuation, found.weight));
}
