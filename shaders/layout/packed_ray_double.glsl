// layout/packed_ray.glsl in double precision: four texels a ray.
real2 texel_to_reals(uvec4 texel) { return real2(packDouble2x32(texel.xy), packDouble2x32(texel.zw)); }
uvec4 reals_to_texel(real a, real b) { return uvec4(unpackDouble2x32(a), unpackDouble2x32(b)); }

PackedRay texels_to_ray(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    real2 first = texel_to_reals(a), second = texel_to_reals(b), third = texel_to_reals(c);
    return PackedRay(real3(first, second.x), second.y, real3(third, packDouble2x32(d.xy)), d.z);
}

#define LOAD_RAY(rays, index)                                                                                                              \
    texels_to_ray(LOAD_TEXEL(rays, (index) * 4), LOAD_TEXEL(rays, (index) * 4 + 1), LOAD_TEXEL(rays, (index) * 4 + 2),               \
                  LOAD_TEXEL(rays, (index) * 4 + 3))
#define LOAD_RAY_PIXEL(rays, index) LOAD_TEXEL(rays, (index) * 4 + 3).z
#define STORE_RAY(rays, index, ray)                                                                                                        \
    STORE_TEXEL(rays, (index) * 4, reals_to_texel((ray).origin.x, (ray).origin.y));                                                        \
    STORE_TEXEL(rays, (index) * 4 + 1, reals_to_texel((ray).origin.z, (ray).length_m));                                                    \
    STORE_TEXEL(rays, (index) * 4 + 2, reals_to_texel((ray).delta.x, (ray).delta.y));                                                      \
    STORE_TEXEL(rays, (index) * 4 + 3, uvec4(unpackDouble2x32((ray).delta.z), (ray).pixel, 0))
