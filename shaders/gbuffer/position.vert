// As gbuffer.vert, for passes that ask nothing else of a surface.
#include "gbuffer/scene_types.glsl"

layout(location = 0) in vec3 position;

void main()
{
    gl_Position = world_to_clip * vec4(position, 1.0);
}
