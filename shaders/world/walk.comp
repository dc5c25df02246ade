// Follows rays through the hierarchy of the scene's triangles to the first one that each meets: the reference price of
// ray tracing. Triangles are tested as Embree does with RTC_SCENE_FLAG_ROBUST, by Pluecker coordinates about the ray's
// origin: neighbours share the bits of their common edge, so that no ray passes between them. The box test is that of
// T. Ize 2013, Robust BVH Ray Traversal, JCGT 2(2).
#include "layout/workgroups.glsl"
#include "layout/texels.glsl"
#include "world/rays.glsl"
#include "world/passes_mask.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
LOADED_TEXELS_4(40, Nodes)     // four texels a node
LOADED_TEXELS_4(41, Triangles) // three texels a triangle
layout(set = 0, binding = 47, scalar) readonly buffer WorldRays { WorldRay rays[]; };
layout(set = 0, binding = 48, scalar) writeonly buffer WorldHits { WorldHit hits[]; };
layout(set = 0, binding = 49, scalar) writeonly buffer NodeVisits { uint node_visits[]; };
layout(set = 0, binding = 50, scalar) readonly buffer WorldLaunch { ListLaunch launch; };

#define MOST_TREE_DEPTH 48
#define MOST_VISITS 60000 // fewer than lavapipe's loops have iterations
#define infinity uintBitsToFloat(0x7F800000u)

// A child of a node: a node, or a run of triangles.
struct Child
{
    vec3 min_ws, max_ws;
    uint first, triangles; // triangles = 0: a node
};

Child load_child(uint node, int side)
{
    uvec4 low = LOAD_TEXEL(Nodes, node * 4 + 2 * side), high = LOAD_TEXEL(Nodes, node * 4 + 2 * side + 1);
    return Child(uintBitsToFloat(low.xyz), uintBitsToFloat(high.xyz), low.w, high.w);
}

// Where the ray enters the box; infinity where it misses it, or enters it behind t_max.
float entry(Child child, WorldRay ray, vec3 inverse, float t_max)
{
    vec3  a = (child.min_ws - ray.origin_ws) * inverse, b = (child.max_ws - ray.origin_ws) * inverse;
    vec3  low = min(a, b), high = max(a, b);
    float t_in  = max(max(low.x, low.y), max(low.z, ray.t_min));
    // By rounding, a box may seem this much smaller than it is.
    float t_out = min(min(high.x, high.y), min(high.z, t_max)) * 1.0000004;
    return t_in * 0.9999996 <= t_out ? t_in : infinity;
}

void meet_triangle(uint triangle, WorldRay ray, inout WorldHit nearest)
{
    uvec4 texel_a = LOAD_TEXEL(Triangles, triangle * 3), texel_b = LOAD_TEXEL(Triangles, triangle * 3 + 1),
          texel_c = LOAD_TEXEL(Triangles, triangle * 3 + 2);
    precise vec3 a = uintBitsToFloat(texel_a.xyz) - ray.origin_ws, b = uintBitsToFloat(texel_b.xyz) - ray.origin_ws,
                 c = uintBitsToFloat(texel_c.xyz) - ray.origin_ws;
    // Twice the volumes that the ray spans with each edge: of one sign where it passes inside.
    precise vec3  across_ca = cross(c - a, c + a), across_ab = cross(a - b, a + b), across_bc = cross(b - c, b + c);
    precise float of_b = dot(across_ca, ray.direction_ws), of_c = dot(across_ab, ray.direction_ws),
                  of_a = dot(across_bc, ray.direction_ws);
    precise float sum = of_a + of_b + of_c;
    float rounding = abs(sum) * 1.1920929e-7;
    if (min(of_a, min(of_b, of_c)) < -rounding && max(of_a, max(of_b, of_c)) > rounding) return;
    vec3  normal = cross(b - c, a - b);
    float t      = dot(a, normal) / dot(normal, ray.direction_ws);
    if (!(t >= ray.t_min && t < nearest.t)) return; // NaN: seen edge-on
    vec2 barycentric = vec2(of_b, of_c) / sum;
    if (passes_mask(texel_b.w, texel_c.w, barycentric)) nearest = WorldHit(t, triangle, barycentric);
}

WorldHit walk(WorldRay ray, out uint visits)
{
    WorldHit nearest = WorldHit(ray.t_max, NO_TRIANGLE, vec2(0));
    vec3     tiny    = vec3(1e-30), direction = ray.direction_ws;
    vec3     inverse = 1.0 / mix(direction, tiny, lessThan(abs(direction), tiny));
    uint     stack[MOST_TREE_DEPTH];
    int      height = 0;
    uint     node   = 0;
    for (visits = 1; visits < MOST_VISITS; ++visits)
    {
        Child left = load_child(node, 0), right = load_child(node, 1);
        float left_t = entry(left, ray, inverse, nearest.t), right_t = entry(right, ray, inverse, nearest.t);
        if (left_t < infinity)
            for (uint i = 0; i < left.triangles; ++i) meet_triangle(left.first + i, ray, nearest);
        if (right_t < infinity)
            for (uint i = 0; i < right.triangles; ++i) meet_triangle(right.first + i, ray, nearest);
        bool to_left = left_t < infinity && left.triangles == 0, to_right = right_t < infinity && right.triangles == 0;
        if (to_left && to_right)
        {
            // The nearer one first.
            stack[height++] = left_t <= right_t ? right.first : left.first;
            node            = left_t <= right_t ? left.first : right.first;
        }
        else if (to_left || to_right)
            node = to_left ? left.first : right.first;
        else if (height > 0)
            node = stack[--height];
        else
            return nearest;
    }
    return WorldHit(0.0, WALK_UNFINISHED, vec2(0));
}

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= launch.count) return;
    uint visits;
    hits[index] = walk(rays[index], visits);
#ifdef COUNT_WORK
    node_visits[index] = visits;
#endif
}
