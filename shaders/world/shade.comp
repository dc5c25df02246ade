// The light that leaves what rays of the world met, toward where they came from: the G-buffer's own light, of textures
// at their finest level. Where the surface reflects, the next ray goes on in the mirror direction, and its light counts by
// the directional albedo, as passes/beta.glsl has it.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"
#include "world/materials.glsl"
#define LIGHTS_BINDING 31
#include "gbuffer/lighting.glsl"
#include "passes/directional_albedo.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 41, scalar) readonly buffer Triangles { uvec4 triangles[]; }; // three a triangle
layout(set = 0, binding = 47, scalar) readonly buffer WorldRays { WorldRay rays[]; };
layout(set = 0, binding = 48, scalar) readonly buffer WorldHits { WorldHit hits[]; };
layout(set = 0, binding = 49, scalar) writeonly buffer WorldLight { vec3 light[]; };
layout(set = 0, binding = 54, scalar) writeonly buffer NextRays { NextRay next[]; };
layout(set = 0, binding = 50, scalar) readonly buffer WorldLaunch { ListLaunch launch; };
layout(push_constant, scalar) uniform Push
{
    vec3  ambient;
    float dielectric_min_f0, dielectric_max_roughness; // of what reflects
    uint  follows;
};
#include "rays/material_reflects.glsl"

const float start_share = 1e-4; // of a ray's length: what the next ray meets nearer is the surface that it leaves
const float far_m       = 1e30;

#define MASKED_BIT 0x80000000u

// On the side that the ray sees, as `front`, which is the triangle's own.
vec3 normal_of(Material material, TrianglePoint point, vec3 direction_ws, out vec3 front)
{
    vec3 normal = vec3(0);
    vec4 tangent = vec4(0);
    for (int i = 0; i < 3; ++i)
    {
        normal += point.weights[i] * corner_of(point, i).normal_ws;
        tangent += point.weights[i] * corner_of(point, i).tangent_ws;
    }
    vec3 a = corner_of(point, 0).position_ws;
    front  = cross(corner_of(point, 1).position_ws - a, corner_of(point, 2).position_ws - a);
    normal = dot(normal, normal) > 0.0 ? normalize(normal) : normalize(front);
    if (dot(tangent.xyz, tangent.xyz) > 0.0)
    {
        vec3 along     = normalize(tangent.xyz - normal * dot(normal, tangent.xyz));
        vec3 bitangent = cross(normal, along) * tangent.w;
        vec3 mapped    = sample_texture(material, 2, point).xyz * 2.0 - 1.0;
        mapped.xy *= material.normal_scale;
        normal = normalize(along * mapped.x + bitangent * mapped.y + normal * mapped.z);
    }
    float side = dot(front, direction_ws) > 0.0 ? -1.0 : 1.0;
    front *= side;
    return side * normal;
}

vec3 light_of(WorldRay ray, WorldHit hit, out NextRay onward)
{
    vec3          weights  = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    TrianglePoint point    = TrianglePoint(triangles[hit.triangle * 3 + 1].w, weights);
    Material      material = materials[triangles[hit.triangle * 3 + 2].w & ~MASKED_BIT];
    vec3 base  = base_colour_at(material, point).rgb;
    vec4 gloss = sample_texture(material, 1, point);
    float metallic  = clamp(material.metallic * gloss.b, 0.0, 1.0);
    float roughness = clamp(material.roughness * gloss.g, 0.0, 1.0);
    vec3 front, normal = normal_of(material, point, ray.direction_ws, front);
    vec3 irradiance, highlights;
    vec3 met_ws = ray.origin_ws + hit.t * ray.direction_ws, along = normalize(ray.direction_ws);
    float blurred = max(roughness, ray.roughness);
    light_surface(Surface(met_ws, normal, base, metallic, blurred, material.dielectric_f0), -along, irradiance, highlights);
    vec3 emissive = material.emissive * sample_texture(material, 3, point).rgb;
    vec3 bounced = vec3(0);
    for (int i = 0; i < 3; ++i) bounced += weights[i] * corner_of(point, i).bounced;
    vec3 below = base * (1.0 - metallic) * (irradiance / pi + ambient + bounced), stand_in = base * metallic * (ambient + bounced);

    vec3 mirrored = reflect(along, normal);
    onward = NextRay(ray, vec3(0));
    if (follows == 0 || !MATERIAL_REFLECTS(metallic, material.dielectric_f0, roughness) || !(dot(mirrored, front) > 0.0))
        return below + stand_in + emissive + highlights;
    vec3 largest  = abs(met_ws);
    onward.ray    = WorldRay(met_ws, max(start_share * hit.t, 4e-6 * max(largest.x, max(largest.y, largest.z))), mirrored, far_m, blurred);
    onward.weight = directional_albedo(mix(vec3(material.dielectric_f0), base, metallic), roughness, abs(dot(normal, along)));
    return below * (1.0 - onward.weight) + emissive + highlights;
}

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= launch.count) return;
    NextRay onward = NextRay(rays[index], vec3(0));
    light[index]   = hits[index].triangle < WALK_UNFINISHED ? light_of(rays[index], hits[index], onward) : vec3(0);
    next[index]    = onward;
}
