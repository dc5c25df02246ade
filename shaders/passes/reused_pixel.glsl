// A pixel as passes/ray_reuse.comp and its filters read it, in one texel, and how far neighbours lie off its surface.
// After passes/reflector.glsl.
struct ReusedPixel
{
    vec4  reflection; // colour, weight; weight < 0: nothing reflects
    float depth;
    float roughness;
    float sharpness;  // the inverse of spread_px()
};

// Rounded to the nearest half: drivers may round toward zero, and each pass that stores one would then darken the picture.
vec4 nearest_half(vec4 value)
{
    uvec4 bits = floatBitsToUint(value);
    return uintBitsToFloat((bits + 0xFFFu + (bits >> 13 & 1u)) & ~0x1FFFu);
}

uvec4 pack_reused(ReusedPixel pixel)
{
    vec4 light = nearest_half(pixel.reflection);
    return uvec4(packHalf2x16(light.rg), packHalf2x16(light.ba), floatBitsToUint(pixel.depth),
                 packHalf2x16(vec2(pixel.roughness, pixel.sharpness)));
}

ReusedPixel unpack_reused(uvec4 texel)
{
    vec2 surface = unpackHalf2x16(texel.w);
    vec4 light   = vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y));
    return ReusedPixel(light, uintBitsToFloat(texel.z), surface.x, surface.y);
}

// By their bits: whether what was a half is below 0, or no number, lavapipe asks lane by lane, in ten instructions each.
bool  is_reflection(vec4 colour_and_weight) { return floatBitsToInt(colour_and_weight.a) >= 0; }
float larger(float a, float b) { return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b))); } // of what is not below 0

const float spread_reach = 3.0; // standard deviations beyond which no pixel counts

// The distance of other pixels' surfaces from the plane of one pixel, over their view distance and
// reuse_depth_tolerance. It is linear in the step to the other pixel and in the difference of depths. In orthographic
// views this holds for the distance alone.
struct SurfacePlane
{
    vec2  per_px;
    float per_depth, depth;
};

SurfacePlane surface_plane(Reflector own, float depth)
{
    vec2  per_px    = own.normal_vs.xy * vec2(1, -1) / focal_px;
    float per_depth = -dot(own.normal_vs, own.position_vs) / near_m;
    if (orthographic != 0) per_depth = own.normal_vs.z * (far_m - near_m);
    return SurfacePlane(per_px / reuse_depth_tolerance, per_depth / reuse_depth_tolerance, depth);
}

float off_surface(SurfacePlane plane, vec2 step_px, float depth)
{
    float off = abs(dot(plane.per_px, step_px) + plane.per_depth * (depth - plane.depth));
    return orthographic != 0 ? off / depth_to_distance(depth) : off;
}
