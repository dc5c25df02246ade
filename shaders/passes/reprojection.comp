// Where each pixel's reflection was in the frame before, by the strategy that the framework composes in (techniques/reprojections/): the mean over the
// pixel's rays that hit and were seen. Where all rays missed, the environment stands for what they met: it is infinitely far.
#include "layout/workgroups.glsl"
#include "api/view.glsl"
#include "trace/ray_list.glsl"
#include "trace/hit_list.glsl"
#include "rays/ray_offset.glsl"
#include "rays/reflecting.glsl"
#include "rays/lobe_threshold.glsl"
#include "passes/camera.glsl"
#include "pass/parameters"
#include "passes/shown_hits.glsl"
#include "passes/previous_frame.glsl"
#include "api/reprojection_api.glsl"
#include "reprojection/parameters"
#include "reprojection/reproject.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 13, rgba32f) uniform writeonly image2D reprojected_image; // px to where it was, ray length, object that was hit
#if LAYERS > 1
layout(set = 0, binding = 90, r32ui) uniform readonly uimage2D layer_1_object_image;
#endif
#if LAYERS > 2
layout(set = 0, binding = 91, r32ui) uniform readonly uimage2D layer_2_object_image;
#endif
#if LAYERS > 3
layout(set = 0, binding = 92, r32ui) uniform readonly uimage2D layer_3_object_image;
#endif

// The surface point that a ray hit, on the plane of its pixel, and its object.
vec3 hit_vs(PackedRay ray, PackedHit found, out uint object)
{
    ivec2 hit   = unpack_pixel(found.pixel);
    vec3  point = ray.origin + ray.delta * found.t;
    object      = imageLoad(object_image, hit).x;
#if LAYERS > 1
    int layer = unpack_layer(found.pixel);
    if (layer == 1) object = imageLoad(layer_1_object_image, hit).x;
#if LAYERS > 2
    if (layer == 2) object = imageLoad(layer_2_object_image, hit).x;
#endif
#if LAYERS > 3
    if (layer == 3) object = imageLoad(layer_3_object_image, hit).x;
#endif
    if (layer > 0) return px_to_vs(point);
#endif
    float depth = depth_on_plane(load_depth(hit), imageLoad(gradient_image, hit).x, point.xy - vec2(hit) - 0.5);
    return px_to_vs(vec3(point.xy, depth));
}

// NaN: behind the camera.
vec2 motion_of(vec3 position_pvs, vec2 px)
{
    return orthographic == 0 && position_pvs.z >= 0.0 ? vec2(uintBitsToFloat(0x7FC00000u)) : pvs_to_px(position_pvs) - px;
}

// At which a ray was mirrored: the surface's, or with rays drawn from a rough surface's lobe the one drawn.
vec3 mirroring_normal(ivec2 pixel, PackedRay ray, vec3 incidence_vs)
{
    vec4 normal = imageLoad(normal_image, pixel);
#ifdef LOBE_RAYS
    if (normal.w >= mirror_roughness)
        return normalize(normalize(px_to_direction_vs(ray.origin, ray.origin + ray.delta)) + to_camera_vs(incidence_vs));
#endif
    return normalize(normal.xyz);
}

Reflection reflection_of(PackedRay ray, PackedHit found, out uint hit_object)
{
    ivec2 pixel  = unpack_pixel(ray.pixel);
    vec3  start  = ray_offset_m > 0.0 ? vec3(vec2(pixel) + 0.5, load_depth(pixel)) : ray.origin;
    uint  object = imageLoad(object_image, pixel).x;
    Reflection now;
    now.incidence_vs        = px_to_vs(start);
    now.incidence_px        = start.xy - jitter_px;
    now.incidence_pvs       = carried_pvs(now.incidence_vs, object);
    now.incidence_motion_px = motion_of(now.incidence_pvs, now.incidence_px);
    now.hit_vs              = hit_vs(ray, found, hit_object);
    now.hit_px              = (ray.origin + ray.delta * found.t).xy - jitter_px;
    now.hit_pvs             = carried_pvs(now.hit_vs, hit_object);
    now.hit_motion_px       = motion_of(now.hit_pvs, now.hit_px);
    now.normal_vs           = mirroring_normal(pixel, ray, now.incidence_vs);
    now.normal_pvs          = turned_pvs(now.normal_vs, object);
    now.ray_length_m        = distance(now.incidence_vs, now.hit_vs);
    return now;
}

// The mirror image of what is infinitely far is infinitely far, too: at the position that its direction has on the image.
vec2 infinite_motion_px(ivec2 pixel, PackedRay ray)
{
    vec3 incidence_vs = px_to_vs(vec3(vec2(pixel) + 0.5, load_depth(pixel))), normal_vs = mirroring_normal(pixel, ray, incidence_vs);
    vec3 seen_pvs     = turned_pvs(reflect(-to_camera_vs(incidence_vs), normal_vs), 0);
    vec3 normal_pvs   = turned_pvs(normal_vs, imageLoad(object_image, pixel).x);
    return motion_of(reflect(seen_pvs, normal_pvs), vec2(pixel) + 0.5 - jitter_px);
}

void main()
{
    uint first = (work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x) * rays_per_pixel;
    if (first >= ray_count) return;
    ivec2 pixel = unpack_pixel(ray_pixel(first));
    if (!reflects(pixel)) return;
    vec2  moved_px = vec2(0);
    float length_m = 0.0;
    uint  hit_object = 0;
    int   hits = 0, seen = 0;
    for (int ray = 0; ray < rays_per_pixel; ++ray)
    {
        PackedHit found = packed_hit(first + ray);
        if (!shows_surface(found)) continue;
        Reflection  now  = reflection_of(packed_ray(first + ray), found, hit_object);
        Reprojected then = reproject(now);
        length_m += now.ray_length_m;
        ++hits;
        if (!then.seen) continue;
        moved_px += then.px - now.incidence_px;
        ++seen;
    }
    if (hits == 0 && orthographic == 0)
        imageStore(reprojected_image, pixel, vec4(infinite_motion_px(pixel, packed_ray(first)), 0, hit_nothing));
    if (hits == 0) return;
    vec2 mean_px = seen > 0 ? moved_px / float(seen) : vec2(uintBitsToFloat(0x7FC00000u));
    imageStore(reprojected_image, pixel, vec4(mean_px, length_m / float(hits), float(hit_object)));
}
