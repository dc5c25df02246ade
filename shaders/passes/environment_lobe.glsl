// The environment as a surface reflects it: sharp for a mirror, else from levels blurred by roughness
// (framework/scene/prefiltered_environment.h), the first half of the split sum.
#include "passes/scene_frame.glsl"
layout(set = 0, binding = 63, rgba32f) uniform readonly image2D environment_map;
// Not an image, of which a device may allow only 16 a shader.
layout(set = 0, binding = 64) uniform sampler2D environment_levels;
#include "gbuffer/environment.glsl"

vec3 level_texel(ivec2 texel, int level, ivec2 size)
{
    return texelFetch(environment_levels, wrapped(texel, size) + ivec2(0, level * size.y), 0).rgb;
}

vec3 level_radiance(vec2 uv, int level, ivec2 size)
{
    vec2  at_px = uv * vec2(size) - 0.5, low = floor(at_px), part = at_px - low;
    ivec2 texel = ivec2(low);
    vec3  upper = mix(level_texel(texel, level, size), level_texel(texel + ivec2(1, 0), level, size), part.x);
    vec3  lower = mix(level_texel(texel + ivec2(0, 1), level, size), level_texel(texel + 1, level, size), part.x);
    return mix(upper, lower, part.y);
}

// A rough lobe lies nearer to the normal than the mirror direction: S. Lagarde, C. de Rousiers 2014, "Moving Frostbite to Physically Based
// Rendering".
vec3 environment_lobe(vec3 mirror_vs, vec3 normal_vs, float roughness)
{
    ivec2 levels_px = textureSize(environment_levels, 0), size = ivec2(levels_px.x, levels_px.x / 2);
    bool  sharp  = levels_px.x < 2 || roughness <= 0.0;
    float alpha = roughness * roughness, to_mirror = (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha);
    vec3  along  = sharp ? mirror_vs : mix(normal_vs, mirror_vs, to_mirror);
    vec2  uv     = direction_to_uv(transpose(mat3(world_to_view)) * along);
    int   levels = levels_px.y / max(size.y, 1);
    float level  = float(levels) * pow(min(roughness, 1.0), 2.0 / 3.0) - 1.0;
    int   finer  = int(floor(level));
    vec3  sharper;
    if (sharp || finer < 0) sharper = environment_radiance(uv);
    else sharper = level_radiance(uv, finer, size);
    return sharp ? sharper : mix(sharper, level_radiance(uv, min(finer + 1, levels - 1), size), level - float(finer));
}
