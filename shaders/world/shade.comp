// The light that leaves what rays of the world met, toward where they came from: the G-buffer's own light, of textures
// at their finest level.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"
#include "world/materials.glsl"
#define LIGHTS_BINDING 31
#include "gbuffer/lighting.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 41, scalar) readonly buffer Triangles { uvec4 triangles[]; }; // three a triangle
layout(set = 0, binding = 47, scalar) readonly buffer WorldRays { WorldRay rays[]; };
layout(set = 0, binding = 48, scalar) readonly buffer WorldHits { WorldHit hits[]; };
layout(set = 0, binding = 49, scalar) writeonly buffer WorldLight { vec3 light[]; };
layout(push_constant, scalar) uniform Push { vec3 ambient; uint ray_count; int light_count; };

#define MASKED_BIT 0x80000000u

// On the side that the ray sees.
vec3 normal_of(WorldMaterial material, TrianglePoint point, vec3 direction_ws)
{
    vec3 normal = vec3(0);
    vec4 tangent = vec4(0);
    for (int i = 0; i < 3; ++i)
    {
        normal += point.weights[i] * corner_of(point, i).normal_ws;
        tangent += point.weights[i] * corner_of(point, i).tangent_ws;
    }
    vec3 a = corner_of(point, 0).position_ws;
    vec3 front = cross(corner_of(point, 1).position_ws - a, corner_of(point, 2).position_ws - a);
    normal = dot(normal, normal) > 0.0 ? normalize(normal) : normalize(front);
    if (dot(tangent.xyz, tangent.xyz) > 0.0)
    {
        vec3 along     = normalize(tangent.xyz - normal * dot(normal, tangent.xyz));
        vec3 bitangent = cross(normal, along) * tangent.w;
        vec3 mapped    = sample_texture(material, 2, point).xyz * 2.0 - 1.0;
        mapped.xy *= material.normal_scale;
        normal = normalize(along * mapped.x + bitangent * mapped.y + normal * mapped.z);
    }
    return dot(front, direction_ws) > 0.0 ? -normal : normal;
}

vec3 light_of(WorldRay ray, WorldHit hit)
{
    vec3          weights  = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    TrianglePoint point    = TrianglePoint(triangles[hit.triangle * 3 + 1].w, weights);
    WorldMaterial material = materials[triangles[hit.triangle * 3 + 2].w & ~MASKED_BIT];
    vec3 base  = base_colour_at(material, point).rgb;
    vec4 gloss = sample_texture(material, 1, point);
    float metallic  = clamp(material.metallic * gloss.b, 0.0, 1.0);
    float roughness = clamp(material.roughness * gloss.g, 0.0, 1.0);
    vec3 normal = normal_of(material, point, ray.direction_ws);
    vec3 irradiance, highlights;
    vec3 met_ws = ray.origin_ws + hit.t * ray.direction_ws;
    light_surface(Surface(met_ws, normal, base, metallic, roughness, material.dielectric_f0), light_count,
                  -normalize(ray.direction_ws), irradiance, highlights);
    vec3 emissive = material.emissive * sample_texture(material, 3, point).rgb;
    return base * ((1.0 - metallic) / pi * irradiance + ambient) + emissive + highlights;
}

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index >= ray_count) return;
    light[index] = hits[index].triangle < WALK_UNFINISHED ? light_of(rays[index], hits[index]) : vec3(0);
}
