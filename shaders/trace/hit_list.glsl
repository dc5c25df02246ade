// What was found of the list of rays, for shaders that read it (trace/trace.comp writes it).
#include "layout/packed_hit.glsl"

layout(set = 0, binding = 9, HIT_FORMAT) uniform readonly uimageBuffer Hits;

PackedHit packed_hit(uint index) { return texel_to_hit(imageLoad(Hits, int(index))); }
