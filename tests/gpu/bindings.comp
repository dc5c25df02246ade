// Copies what it reads as texels.
#include "layout/float_texels.glsl"
layout(local_size_x = 4) in;
LOADED_FLOATS(0, Floats)
LOADED_TEXELS_1(1, Words)
layout(set = 0, binding = 2, scalar) writeonly buffer FloatCopies { float float_copies[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer WordCopies { uint word_copies[]; };

void main()
{
    uint i          = gl_LocalInvocationID.x;
    float_copies[i] = LOAD_TEXEL(Floats, i).x;
    word_copies[i]  = LOAD_TEXEL(Words, i).x;
}
