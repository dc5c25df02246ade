// How much of a reflector's colour its reflection is: beta = reflectance * weight of the reflection. After view.glsl, reflecting.glsl and
// pass/parameters. J. Somerville Roberts, "Screen Space Reflections".

#include "passes/directional_albedo.glsl"

vec3 to_camera_vs(ivec2 pixel)
{
    vec3 position_vs = px_to_vs(vec3(vec2(pixel) + 0.5, load_depth(pixel)));
    return orthographic != 0 ? vec3(0, 0, 1) : -normalize(position_vs);
}

vec3 reflectance_of(ivec2 pixel, vec3 to_eye_vs)
{
    vec4 material = imageLoad(material_image, pixel);
    if (reflectance == reflectance_metallic)
        return vec3(metallic_exponent > 0.0 ? pow(material.a, metallic_exponent) : 1.0);
    vec4 normal = imageLoad(normal_image, pixel);
    vec2 terms  = dfg(normal.w, max(dot(normalize(normal.xyz), to_eye_vs), 0.0));
    return clamp(mix(vec3(0.04), material.rgb, material.a) * terms.x + terms.y, 0.0, 1.0);
}

vec3 beta_of(ivec2 reflector, vec3 to_eye_vs, float weight)
{
    if (weight <= 0.0) return vec3(0);
    return reflectance_of(reflector, to_eye_vs) * weight;
}
