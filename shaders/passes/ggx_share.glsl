// The share of light that a GGX surface reflects, averaged over its lobe, is f0 * x + y (render/ggx_share.h).
layout(set = 0, binding = 36) uniform sampler2D ggx_shares;

vec2 ggx_share(float roughness, float cosine)
{
    const float entries = float(GGX_SHARE_ENTRIES);
    return textureLod(ggx_shares, (vec2(sqrt(cosine), roughness) * (entries - 1.0) + 0.5) / entries, 0.0).xy;
}
