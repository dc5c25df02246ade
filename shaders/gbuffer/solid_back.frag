// The nearest surface behind the one that the G-buffer shows: its depth where it shows its back, so that what lies between the two is solid; else 0.
#include "gbuffer/cut_out.glsl"
#define DEPTH_BINDING 5
layout(set = 0, binding = 0, scalar) uniform Frame // as gbuffer.frag declares it
{
    mat4  world_to_view;
    vec3  eye_ws;
    int   orthographic;
    vec3  view_axis_ws;
    vec3  ambient;
    float layer_separation;
    ivec2 size_px;
};
#include "layout/load_depth.glsl"

layout(location = 0) out float solid_back;

// Of depth: what lies nearer behind the first surface is the same surface.
const float same_surface = 1.0 / 65536.0;

void main()
{
    discard_cut_out();
    float first = load_depth(ivec2(gl_FragCoord.xy));
    if (gl_FragCoord.z >= first - first * same_surface) discard;
    solid_back = gl_FrontFacing ? 0.0 : gl_FragCoord.z;
}
