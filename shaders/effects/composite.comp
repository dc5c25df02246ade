// The picture: C = C_own + (C_reflected - C_own) * beta, beta = reflectance * weight of the reflection.
// J. Somerville Roberts, "Screen Space Reflections".
#include "view.glsl"
#include "reflecting.glsl"
#include "effect/parameters"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 5, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 6, rgba16f) uniform readonly image2D reflection_image; // a < 0: nothing
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D shaded_image;

// The share of light that a GGX surface reflects, averaged over its lobe: B. Karis 2014, Physically Based Shading on Mobile.
vec3 ggx_reflectance(vec3 f0, float roughness, float cosine)
{
    vec4  r    = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    vec2  ab   = vec2(-1.04, 1.04) * a004 + r.zw;
    return clamp(f0 * ab.x + ab.y, 0.0, 1.0);
}

vec3 reflectance_of(ivec2 pixel)
{
    vec4 material = imageLoad(material_image, pixel);
    if (reflectance == reflectance_metallic)
        return vec3(metallic_exponent > 0.0 ? pow(material.a, metallic_exponent) : 1.0);
    vec4 normal      = imageLoad(normal_image, pixel);
    vec3 position_vs = px_to_vs(vec3(vec2(pixel) + 0.5, imageLoad(depth_image, pixel).x));
    vec3 to_eye      = orthographic != 0 ? vec3(0, 0, 1) : -normalize(position_vs);
    return ggx_reflectance(mix(vec3(0.04), material.rgb, material.a), normal.w, max(dot(normalize(normal.xyz), to_eye), 0.0));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shaded_image)))) return;
    vec3 colour     = imageLoad(radiance_image, pixel).rgb + imageLoad(highlight_image, pixel).rgb;
    vec4 reflection = imageLoad(reflection_image, pixel);
    if (reflection.a > 0.0)
    {
        colour += (reflection.rgb - colour) * (reflectance_of(pixel) * reflection.a);
    }
    imageStore(shaded_image, pixel, vec4(colour, 1));
}
