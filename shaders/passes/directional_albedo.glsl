// The split-sum table: the directional albedo of a GGX surface is f0 * x + f90 * y (frame/directional_albedo.h).
#include "layout/frame_shared.h"
#include "gbuffer/grazing.glsl"
layout(set = 0, binding = 36) uniform sampler2D dfg_table;

vec2 dfg(float roughness, float cosine)
{
    const float entries = float(DFG_TABLE_ENTRIES);
    return textureLod(dfg_table, (vec2(sqrt(cosine), roughness) * (entries - 1.0) + 0.5) / entries, 0.0).xy;
}

vec3 directional_albedo(vec3 f0, float roughness, float cosine)
{
    vec2 terms = dfg(roughness, min(cosine, 1.0));
    return clamp(f0 * terms.x + grazing_reflectance(f0) * terms.y, 0.0, 1.0);
}
