// packed_hit.glsl for the double twin.
#define LOADED_HITS LOADED_TEXELS_4
#define STORED_HITS STORED_TEXELS_4
uvec4 hit_to_texel(PackedHit hit) { return uvec4(hit.pixel, 0, unpackDouble2x32(hit.t)); }
PackedHit texel_to_hit(uvec4 texel) { return PackedHit(texel.x, packDouble2x32(texel.zw)); }
