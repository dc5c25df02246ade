// environment_radiance at a list of directions.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D environment_map;
layout(set = 0, binding = 1, scalar) readonly buffer Directions { vec3 directions[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer Radiances { vec3 radiances[]; };
#include "gbuffer/environment.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= directions.length()) return;
    radiances[i] = environment_radiance(direction_to_uv(directions[i]));
}
