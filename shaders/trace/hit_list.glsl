// What was found of the list of rays, for shaders that read it (trace/trace.comp writes it).
#include "layout/packed_hit.glsl"

LOADED_HITS(9, Hits)

PackedHit packed_hit(uint index) { return texel_to_hit(LOAD_TEXEL(Hits, index)); }
