// What the camera sees: geometry, material, and the lit colour in two parts (same from every direction; depends on the view).
#include "gbuffer/scene_types.glsl"
#include "gbuffer/material.glsl"

layout(set = 0, binding = 0, scalar) uniform Frame
{
    mat4  world_to_view;
    vec3  eye_ws;          // perspective: position
    int   orthographic;
    vec3  view_axis_ws;    // orthographic: direction of view
    vec3  ambient;
    float layer_separation; // peeled: at least so far behind the layer before; in units of the near distance, or of the depth range
    ivec2 size_px;
};
#define LIGHTS_BINDING 2
#include "gbuffer/lighting.glsl"
#ifdef PEELED
#define DEPTH_BINDING 5 // of the layer before this one
#include "layout/load_depth.glsl"
#endif

layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec4 tangent_ws;
layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 vertex_colour;
layout(location = 5) in vec3 bounced_light; // of a white diffuse surface

layout(location = 0) out vec4 normal_and_roughness; // view space
layout(location = 1) out vec4 base_and_metallic;
layout(location = 2) out vec4 radiance;             // the same from every direction
layout(location = 3) out vec4 highlight;            // depends on the view
layout(location = 4) out uint object;
layout(location = 5) out uint gradient; // of depth, as framework/core/plane_gradient.h packs it
layout(location = 6) out float dielectric_f0;
layout(location = 7) out vec4 emission;             // part of radiance; a: diffuse_share()

vec3 shading_normal(Material material, Coordinates at)
{
    vec3 normal = normalize(normal_ws);
    if (dot(tangent_ws.xyz, tangent_ws.xyz) > 0.0)
    {
        vec3 tangent   = normalize(tangent_ws.xyz - normal * dot(normal, tangent_ws.xyz));
        vec3 bitangent = cross(normal, tangent) * tangent_ws.w;
        vec3 mapped    = sample_texture(normal_texture, material, 2, at).xyz * 2.0 - 1.0;
        mapped.xy *= material.normal_scale;
        normal = normalize(tangent * mapped.x + bitangent * mapped.y + normal * mapped.z);
    }
    return material.double_sided != 0 && !gl_FrontFacing ? -normal : normal;
}

#ifdef PEELED
// Of depth: what lies nearer behind a surface is the same surface.
const float same_surface = 1.0 / 65536.0;

// Depth peeling: the nearest of all that lies behind what the layer before shows. C. Everitt 2001, Interactive Order-Independent
// Transparency; with a minimum separation as M. Mara et al. 2016, Deep G-Buffers for Stable Global Illumination Approximation.
bool is_peeled_off()
{
    float before = load_depth(ivec2(gl_FragCoord.xy));
    float limit  = orthographic != 0 ? before - layer_separation : before / (1.0 + layer_separation * before);
    return before <= 0.0 || gl_FragCoord.z >= min(limit, before - before * same_surface);
}
#endif

// The rasteriser's depth is linear across a triangle, so differences between pixels of a quad are its plane's own.
uint packed_gradient(float depth, vec2 slope)
{
    float limit = orthographic != 0 ? 1.0 : depth;
    bool  finite = !any(isnan(slope)) && !any(isinf(slope));
    uvec2 bits  = floatBitsToUint(clamp(slope, vec2(-limit), vec2(limit))) + 0x8000u;
    return finite ? (bits.x & 0xFFFF0000u) | bits.y >> 16 : 0xFFFFFFFFu;
}

// Of the radiance without emission and metal's share of ambient light, what is diffuse. The rest is baked light that, like ambient light,
// stands in for what a metal reflects.
float diffuse_share(vec3 base, float metallic, vec3 diffuse_light)
{
    float stand_in = metallic * dot(base, bounced_light);
    float diffuse  = (1.0 - metallic) * dot(base, diffuse_light / pi + ambient + bounced_light);
    return stand_in > 0.0 ? diffuse / (diffuse + stand_in) : 1.0;
}

void main()
{
    vec2        depth_slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z));
    Coordinates at       = coordinates_of(uv);
    Material    material = materials[material_index];
    vec4        base     = base_colour_of(material, at, vertex_colour);
    if (is_cut_out(material, base.a)) discard;
#ifdef PEELED
    if (is_peeled_off()) discard;
#endif
    vec4  metallic_roughness = sample_texture(metallic_roughness_texture, material, 1, at);
    float metallic  = clamp(material.metallic * metallic_roughness.b, 0.0, 1.0);
    float roughness = clamp(material.roughness * metallic_roughness.g, 0.0, 1.0);
    vec3  normal    = shading_normal(material, at);
    vec3  to_eye    = orthographic != 0 ? -view_axis_ws : normalize(eye_ws - position_ws);
    vec3  diffuse_light, highlights;
    light_surface(Surface(position_ws, normal, base.rgb, metallic, roughness, material.dielectric_f0), to_eye, diffuse_light, highlights);
    vec3 emissive = min(material.emissive * sample_texture(emissive_texture, material, 3, at).rgb, largest_half);

    normal_and_roughness = vec4(mat3(world_to_view) * normal, roughness);
    base_and_metallic    = vec4(base.rgb, metallic);
    radiance             = vec4(min(base.rgb * ((1.0 - metallic) / pi * diffuse_light + ambient + bounced_light) + emissive, largest_half), 1.0);
    highlight            = vec4(highlights, 1.0);
    emission             = vec4(emissive, diffuse_share(base.rgb, metallic, diffuse_light));
    object               = object_id;
    dielectric_f0        = material.dielectric_f0;
    gradient             = packed_gradient(gl_FragCoord.z, depth_slope);
}
