// World space (relative to the scene's origin) to clip space; everything else passes through.
#include "gbuffer/scene_types.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv0;
layout(location = 4) in vec2 uv1;
layout(location = 5) in vec4 colour;
layout(location = 6) in vec3 bounced;

layout(location = 0) out vec3 position_ws;
layout(location = 1) out vec3 normal_ws;
layout(location = 2) out vec4 tangent_ws;
layout(location = 3) out vec4 uv;
layout(location = 4) out vec4 vertex_colour;
layout(location = 5) out vec3 bounced_light;

void main()
{
    position_ws   = position;
    normal_ws     = normal;
    tangent_ws    = tangent;
    uv            = vec4(uv0, uv1);
    vertex_colour = colour;
    bounced_light = bounced;
    gl_Position   = world_to_clip * vec4(position, 1.0);
}
