// The split-sum table: the directional albedo of a GGX surface is f0 * x + y (render/directional_albedo.h).
#include "layout/frame_shared.h"
layout(set = 0, binding = 36) uniform sampler2D dfg_table;

vec2 dfg(float roughness, float cosine)
{
    const float entries = float(DFG_TABLE_ENTRIES);
    return textureLod(dfg_table, (vec2(sqrt(cosine), roughness) * (entries - 1.0) + 0.5) / entries, 0.0).xy;
}
