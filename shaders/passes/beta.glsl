// What a reflector shows with its reflection. After view.glsl, reflecting.glsl and pass/parameters.
#include "passes/camera.glsl"
#include "passes/directional_albedo.glsl"

layout(set = 0, binding = 61, rgba16f) uniform readonly image2D emission_image; // part of radiance; a: diffuse_share() of gbuffer.frag
layout(set = 0, binding = 62, scalar) uniform Ambient { vec3 ambient; }; // 0 where there is no scene

vec3 to_camera_vs(ivec2 pixel) { return to_camera_vs(px_to_vs(vec3(vec2(pixel) + 0.5, load_depth(pixel)))); }

// reflectance = metallic: J. Somerville Roberts, "Screen Space Reflections". ggx: the directional albedo.
vec3 reflectance_of(ivec2 pixel, vec3 to_eye_vs)
{
    vec4 material = imageLoad(material_image, pixel);
    if (reflectance == reflectance_metallic)
        return vec3(metallic_exponent > 0.0 ? pow(material.a, metallic_exponent) : 1.0);
    vec4 normal = imageLoad(normal_image, pixel);
    vec3 f0     = mix(vec3(imageLoad(dielectric_image, pixel).x), material.rgb, material.a);
    return directional_albedo(f0, normal.w, abs(dot(normalize(normal.xyz), to_eye_vs)));
}

// own: the reflector's light that is equal in every direction; highlight: the rest of it. What the reflector emits stays whole: the
// rendering equation adds it to what is scattered. Of the rest the reflection takes the place by its weight: with metallic, of all of it; with
// ggx, of the ambient and baked light that stand in for it on metals, and it dims what comes from below the surface by what it reflects itself.
vec3 with_reflection(ivec2 reflector, vec3 to_eye_vs, vec3 own, vec3 highlight, vec3 reflected, float weight)
{
    if (weight <= 0.0) return own + highlight;
    vec3 share     = reflectance_of(reflector, to_eye_vs);
    vec4 emission  = imageLoad(emission_image, reflector);
    vec3 scattered = max(own - emission.rgb, 0.0);
    if (reflectance == reflectance_metallic) return own + highlight + (reflected - scattered - highlight) * share * weight;
    vec4 material = imageLoad(material_image, reflector);
    vec3 below    = max(scattered - material.a * material.rgb * ambient, 0.0) * emission.a;
    return own + highlight + (below * (1.0 - share) + reflected * share - scattered) * weight;
}
