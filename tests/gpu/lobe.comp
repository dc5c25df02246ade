// lobe_value and lobe_density for a list of directions to the eye and to the light. The normal is +z.
layout(local_size_x = 64) in;
struct Asked
{
    vec3  to_eye, to_light;
    float alpha;
};
layout(set = 0, binding = 0, scalar) readonly buffer AskedLobes { Asked asked[]; };
layout(set = 0, binding = 1, scalar) writeonly buffer FoundLobes { vec2 found[]; };
vec2 centre_px = vec2(0);
#include "api/hash.glsl"
#include "rays/lobe.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= asked.length()) return;
    Asked one  = asked[i];
    Lobe  lobe = lobe_of(vec3(0, 0, 1), one.to_eye, one.alpha);
    found[i] = vec2(lobe_value(lobe, one.to_light), lobe_density(vec3(0, 0, 1), one.to_eye, one.to_light, one.alpha));
}
