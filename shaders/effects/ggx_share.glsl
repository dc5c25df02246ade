// The share of light that a GGX surface reflects, averaged over its lobe, is f0 * x + y (render/ggx_share.h).
layout(set = 0, binding = 36, scalar) readonly buffer GgxShares { vec2 ggx_shares[]; };

vec2 ggx_share(float roughness, float cosine)
{
    const int last  = GGX_SHARE_ENTRIES - 1;
    vec2      place = clamp(vec2(sqrt(cosine), roughness), 0.0, 1.0) * float(last);
    ivec2     from  = min(ivec2(place), last - 1);
    vec2      share = place - vec2(from);
    int       first = from.y * GGX_SHARE_ENTRIES + from.x;
    vec2 smoother = mix(ggx_shares[first], ggx_shares[first + 1], share.x);
    vec2 rougher  = mix(ggx_shares[first + GGX_SHARE_ENTRIES], ggx_shares[first + GGX_SHARE_ENTRIES + 1], share.x);
    return mix(smoother, rougher, share.y);
}
