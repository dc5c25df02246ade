// Light that arrives at a point and leaves it toward an eye: Lambert diffuse; GGX specular with Smith visibility and Schlick
// Fresnel (Walter et al. 2007; Schlick 1994). The including shader defines LIGHTS_BINDING, and two more after it.
#include "layout/texels.glsl"

struct Light
{
    vec3  position_ws;
    int   type;          // 0 directional, 1 point, 2 spot
    vec3  direction_ws;  // from the light into the scene
    float range_m;       // 0 = unlimited
    vec3  intensity;     // directional: irradiance; point, spot: radiant intensity
    int   shadow_layer;  // first layer of the shadow map, -1 = none
    float cos_inner;
    float cos_outer;
};

LOADED_TEXELS_4(LIGHTS_BINDING, Lights)             // four texels a light
LOADED_TEXELS_4(LIGHTS_BINDING + 1, ShadowMatrices) // four texels a layer of the shadow map: columns of world to clip
layout(set = 0, binding = LIGHTS_BINDING + 2) uniform sampler2DArrayShadow shadow_map;

const float pi              = 3.14159265358979;
const float nearest_light_m = 1e-6; // a light has no size, and lights nothing in its own place
const float largest_half    = 65504.0; // what pictures can hold

Light load_light(int index)
{
    uvec4 texels[4];
    for (int i = 0; i < 4; ++i) texels[i] = LOAD_TEXEL(Lights, 4 * index + i);
    vec2 cosines = uintBitsToFloat(texels[3].xy);
    return Light(uintBitsToFloat(texels[0].xyz), int(texels[0].w), uintBitsToFloat(texels[1].xyz),
                 uintBitsToFloat(texels[1].w), uintBitsToFloat(texels[2].xyz), int(texels[2].w), cosines.x, cosines.y);
}

mat4 load_world_to_shadow(int layer)
{
    mat4 columns;
    for (int i = 0; i < 4; ++i) columns[i] = uintBitsToFloat(LOAD_TEXEL(ShadowMatrices, 4 * layer + i));
    return columns;
}

// Layer of a point light's cube: +x -x +y -y +z -z.
int cube_face(vec3 direction)
{
    vec3 a = abs(direction);
    if (a.x >= a.y && a.x >= a.z) return direction.x > 0.0 ? 0 : 1;
    if (a.y >= a.z) return direction.y > 0.0 ? 2 : 3;
    return direction.z > 0.0 ? 4 : 5;
}

float shadow(Light light, vec3 position_ws)
{
    if (light.shadow_layer < 0) return 1.0;
    int  layer = light.shadow_layer + (light.type == 1 ? cube_face(position_ws - light.position_ws) : 0);
    vec4 clip  = load_world_to_shadow(layer) * vec4(position_ws, 1.0);
    if (clip.w <= 0.0) return 1.0;
    vec3 ndc = clip.xyz / clip.w;
    if (any(greaterThan(abs(ndc.xy), vec2(1.0))) || ndc.z > 1.0) return 1.0;
    return texture(shadow_map, vec4(ndc.xy * 0.5 + 0.5, layer, ndc.z));
}

// Irradiance on a plane facing the light, and the direction toward the light.
vec3 arriving(Light light, vec3 position_ws, out vec3 to_light)
{
    to_light = -light.direction_ws;
    if (light.type == 0) return light.intensity;
    vec3  offset     = light.position_ws - position_ws;
    float distance_m = length(offset);
    to_light         = vec3(0);
    if (distance_m <= nearest_light_m) return vec3(0);
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

#include "gbuffer/grazing.glsl"

vec3 specular(vec3 normal, vec3 to_eye, vec3 to_light, vec3 f0, float roughness)
{
    vec3  sum     = to_eye + to_light;
    vec3  halfway = dot(sum, sum) > 0.0 ? normalize(sum) : normal;
    float alpha2  = pow(max(roughness, 0.05), 4.0);
    float n_h = max(dot(normal, halfway), 0.0), n_v = max(dot(normal, to_eye), 1e-4), n_l = max(dot(normal, to_light), 0.0);
    float d   = n_h * n_h * (alpha2 - 1.0) + 1.0;
    float ggx = alpha2 / (pi * d * d);
    float visibility = 0.5 / max(n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2) + n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2), 1e-6);
    vec3  fresnel = f0 + (grazing_reflectance(f0) - f0) * pow(1.0 - clamp(dot(to_eye, halfway), 0.0, 1.0), 5.0);
    return ggx * visibility * fresnel;
}

struct Surface
{
    vec3  position_ws, normal_ws, base_colour;
    float metallic, roughness, dielectric_f0;
};

// Not a uniform: lavapipe compiles a shader that loops up to one anew for each launch.
int light_count() { return TEXEL_COUNT(Lights) / 4; }

// Returns which of 32 lights reach the surface, without shadows: bit i for the light first + i.
uint reaching_lights(Surface surface, int first)
{
    uint reaching = 0;
    int  count = min(light_count() - first, 32), i = 0;
    do
    {
        vec3 to_light;
        vec3 from_light = arriving(load_light(first + i), surface.position_ws, to_light);
        bool reaches = i < count && !(dot(surface.normal_ws, to_light) <= 0.0) && any(notEqual(from_light, vec3(0)));
        reaching |= uint(reaches) << (i & 31);
    } while (++i < count);
    return reaching;
}

// Both parts of the light that leaves a surface: irradiance for the diffuse one, radiance toward the eye for the
// specular one. Only for lights that reach the surface are the shadow and the highlight computed. The loops test their
// condition at the end, because lavapipe runs the body of a loop that tests it first once more than needed.
void light_surface(Surface surface, vec3 to_eye_ws, out vec3 irradiance, out vec3 highlights)
{
    vec3 f0    = mix(vec3(surface.dielectric_f0), surface.base_colour, surface.metallic);
    irradiance = highlights = vec3(0);
    int first  = 0;
    do
    {
        uint reaching = reaching_lights(surface, first);
        do
        {
            if (reaching != 0)
            {
                Light light = load_light(first + findLSB(reaching));
                vec3  to_light;
                vec3  from_light = arriving(light, surface.position_ws, to_light);
                from_light *= dot(surface.normal_ws, to_light) * shadow(light, surface.position_ws);
                irradiance += from_light;
                highlights += from_light * specular(surface.normal_ws, to_eye_ws, to_light, f0, surface.roughness);
                reaching &= reaching - 1;
            }
        } while (reaching != 0);
        first += 32;
    } while (first < light_count());
    irradiance = min(irradiance, largest_half);
    highlights = min(highlights, largest_half);
}
