// How much of a reflector's colour its reflection is: beta = reflectance * weight of the reflection. After view.glsl, reflecting.glsl and
// effect/parameters. J. Somerville Roberts, "Screen Space Reflections".

// The share of light that a GGX surface reflects, averaged over its lobe: B. Karis 2014, Physically Based Shading on Mobile.
vec3 ggx_reflectance(vec3 f0, float roughness, float cosine)
{
    vec4  r    = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    vec2  ab   = vec2(-1.04, 1.04) * a004 + r.zw;
    return clamp(f0 * ab.x + ab.y, 0.0, 1.0);
}

vec3 to_camera_vs(ivec2 pixel)
{
    vec3 position_vs = px_to_vs(vec3(vec2(pixel) + 0.5, imageLoad(depth_image, pixel).x));
    return orthographic != 0 ? vec3(0, 0, 1) : -normalize(position_vs);
}

vec3 reflectance_of(ivec2 pixel, vec3 to_eye_vs)
{
    vec4 material = imageLoad(material_image, pixel);
    if (reflectance == reflectance_metallic)
        return vec3(metallic_exponent > 0.0 ? pow(material.a, metallic_exponent) : 1.0);
    vec4 normal = imageLoad(normal_image, pixel);
    return ggx_reflectance(mix(vec3(0.04), material.rgb, material.a), normal.w, max(dot(normalize(normal.xyz), to_eye_vs), 0.0));
}

vec3 beta_of(ivec2 reflector, vec3 to_eye_vs, float weight)
{
    if (weight <= 0.0) return vec3(0);
    return reflectance_of(reflector, to_eye_vs) * weight;
}
