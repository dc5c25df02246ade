// What the camera sees: geometry, material, and the lit colour in two parts (same from every direction; depends on the view).
// Lambert diffuse; GGX specular with Smith visibility and Schlick Fresnel (Walter et al. 2007; Schlick 1994).
#include "scene_types.glsl"
#include "material.glsl"

layout(set = 0, binding = 0, scalar) uniform Frame
{
    mat4  world_to_view;
    vec3  eye_ws;          // perspective: position
    int   orthographic;
    vec3  view_axis_ws;    // orthographic: direction of view
    int   light_count;
    vec3  ambient;
    float layer_separation; // second layer: at least so far behind the first; in units of the near distance, or of the depth range
};
layout(set = 0, binding = 2, scalar) readonly buffer Lights { Light lights[]; };
layout(set = 0, binding = 3, scalar) readonly buffer ShadowMatrices { mat4 world_to_shadow[]; };
layout(set = 0, binding = 4) uniform sampler2DArrayShadow shadow_map;
#ifdef SECOND_LAYER
layout(set = 0, binding = 5, r32f) uniform readonly image2D first_depth;
#endif

layout(location = 0) in vec3 position_ws;
layout(location = 1) in vec3 normal_ws;
layout(location = 2) in vec4 tangent_ws;
layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 vertex_colour;

layout(location = 0) out vec4 normal_and_roughness; // view space
layout(location = 1) out vec4 base_and_metallic;
layout(location = 2) out vec4 radiance;             // the same from every direction
layout(location = 3) out vec4 highlight;            // depends on the view
layout(location = 4) out uint object;

const float pi = 3.14159265358979;

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

// Layer of a point light's cube: +x -x +y -y +z -z.
int cube_face(vec3 direction)
{
    vec3 a = abs(direction);
    if (a.x >= a.y && a.x >= a.z) return direction.x > 0.0 ? 0 : 1;
    if (a.y >= a.z) return direction.y > 0.0 ? 2 : 3;
    return direction.z > 0.0 ? 4 : 5;
}

float shadow(Light light, vec3 normal)
{
    if (light.shadow_layer < 0) return 1.0;
    int  layer = light.shadow_layer + (light.type == 1 ? cube_face(position_ws - light.position_ws) : 0);
    vec4 clip  = world_to_shadow[layer] * vec4(position_ws, 1.0);
    if (clip.w <= 0.0) return 1.0;
    vec3 ndc = clip.xyz / clip.w;
    if (any(greaterThan(abs(ndc.xy), vec2(1.0))) || ndc.z > 1.0) return 1.0;
    return texture(shadow_map, vec4(ndc.xy * 0.5 + 0.5, layer, ndc.z));
}

// Irradiance on a plane facing the light, and the direction toward the light.
vec3 arriving(Light light, out vec3 to_light)
{
    to_light = -light.direction_ws;
    if (light.type == 0) return light.intensity;
    vec3  offset     = light.position_ws - position_ws;
    float distance_m = length(offset);
    to_light         = offset / distance_m;
    float window     = light.range_m > 0.0 ? clamp(1.0 - pow(distance_m / light.range_m, 4.0), 0.0, 1.0) : 1.0;
    float cone       = 1.0;
    if (light.type == 2)
    {
        float range = max(light.cos_inner - light.cos_outer, 1e-4);
        cone        = clamp((dot(light.direction_ws, -to_light) - light.cos_outer) / range, 0.0, 1.0);
        cone *= cone;
    }
    return light.intensity * (window * cone / (distance_m * distance_m));
}

vec3 specular(vec3 normal, vec3 to_eye, vec3 to_light, vec3 f0, float roughness)
{
    vec3  halfway = normalize(to_eye + to_light);
    float alpha2  = pow(max(roughness, 0.05), 4.0);
    float n_h = max(dot(normal, halfway), 0.0), n_v = max(dot(normal, to_eye), 1e-4), n_l = max(dot(normal, to_light), 0.0);
    float d   = n_h * n_h * (alpha2 - 1.0) + 1.0;
    float ggx = alpha2 / (pi * d * d);
    float visibility = 0.5 / max(n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2) + n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2), 1e-6);
    vec3  fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(to_eye, halfway), 0.0), 5.0);
    return ggx * visibility * fresnel;
}

#ifdef SECOND_LAYER
// Depth peeling: the nearest of all that lies behind what the first layer shows. C. Everitt 2001, Interactive Order-Independent
// Transparency; with a minimum separation as M. Mara et al. 2016, Deep G-Buffers for Stable Global Illumination Approximation.
bool is_peeled_off()
{
    float first = imageLoad(first_depth, ivec2(gl_FragCoord.xy)).x;
    float limit = orthographic != 0 ? first - layer_separation : first / (1.0 + layer_separation * first);
    return first <= 0.0 || gl_FragCoord.z >= limit;
}
#endif

void main()
{
    Coordinates at       = coordinates_of(uv);
    Material    material = materials[material_index];
    vec4        base     = base_colour_of(material, at, vertex_colour);
    if (material.alpha_cutoff >= 0.0 && base.a < material.alpha_cutoff) discard;
#ifdef SECOND_LAYER
    if (is_peeled_off()) discard;
#endif
    vec4  metallic_roughness = sample_texture(metallic_roughness_texture, material, 1, at);
    float metallic  = clamp(material.metallic * metallic_roughness.b, 0.0, 1.0);
    float roughness = clamp(material.roughness * metallic_roughness.g, 0.0, 1.0);
    vec3  normal    = shading_normal(material, at);
    vec3  to_eye    = orthographic != 0 ? -view_axis_ws : normalize(eye_ws - position_ws);
    vec3  f0        = mix(vec3(0.04), base.rgb, metallic);

    vec3 diffuse_light = vec3(0), highlights = vec3(0);
    for (int i = 0; i < light_count; ++i)
    {
        vec3  to_light;
        vec3  irradiance = arriving(lights[i], to_light);
        float cosine     = dot(normal, to_light);
        if (cosine <= 0.0) continue;
        irradiance *= cosine * shadow(lights[i], normal);
        diffuse_light += irradiance;
        highlights += irradiance * specular(normal, to_eye, to_light, f0, roughness);
    }
    vec3 emissive = material.emissive * sample_texture(emissive_texture, material, 3, at).rgb;

    normal_and_roughness = vec4(mat3(world_to_view) * normal, roughness);
    base_and_metallic    = vec4(base.rgb, metallic);
    radiance             = vec4(base.rgb * ((1.0 - metallic) / pi * diffuse_light + ambient) + emissive, 1.0);
    highlight            = vec4(highlights, 1.0);
    object               = object_id;
}
