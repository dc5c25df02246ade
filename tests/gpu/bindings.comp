// Copies what it reads as texels.
layout(local_size_x = 4) in;
layout(set = 0, binding = 0, r32f) uniform readonly imageBuffer Floats;
layout(set = 0, binding = 1, r32ui) uniform readonly uimageBuffer Words;
layout(set = 0, binding = 2, scalar) writeonly buffer FloatCopies { float float_copies[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer WordCopies { uint word_copies[]; };

void main()
{
    uint i          = gl_LocalInvocationID.x;
    float_copies[i] = imageLoad(Floats, int(i)).x;
    word_copies[i]  = imageLoad(Words, int(i)).x;
}
