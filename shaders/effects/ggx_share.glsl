// The share of light that a GGX surface reflects, averaged over its lobe, is f0 * x + y: B. Karis 2014, Physically Based Shading on Mobile.
vec2 ggx_share(float roughness, float cosine)
{
    vec4  r    = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float a004 = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a004 + r.zw;
}
